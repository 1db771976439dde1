#!/usr/bin/env python3
"""The values of FLIP that tests/flip_test.cc expects, of the authors' implementation, for the same pictures.

    pip install flip-evaluator==1.7; tests/flip_values.py
"""
import flip_evaluator
import numpy as np

WIDTH, HEIGHT = 96, 64


def picture(change, lamp):
    """As picture() of flip_test.cc, bit for bit."""
    y, x, c = np.meshgrid(range(HEIGHT), range(WIDTH), range(3), indexing='ij')
    centre = 50 if change == 'moved' else 48
    disc = (x - centre)**2 + (y - 32)**2 < 400
    values = np.where(disc, np.float32([0.75, 0.5, 0.25])[c], ((x + 2 * y + 16 * c) / 512).astype(np.float32))
    if lamp:
        values = np.where((y < 8) & (32 <= x) & (x < 64), np.float32(48), values)
    if change == 'noisy':
        mixed = np.uint32((x * 7349 + y * 9151 + c * 3571) & 0xFFFFFFFF) * np.uint32(2654435761)
        values = values * (np.float32(0.5) + (mixed >> np.uint32(16)).astype(np.float32) / np.float32(65536))
    if change == 'tinted':
        values = values * np.where(c == 2, np.float32(1.25), np.float32(1))
    return np.ascontiguousarray(values, dtype=np.float32)


def main():
    for lamp in (False, True):
        for change in ('noisy', 'moved', 'tinted'):
            for ppd in (67.0206433, 20):
                pictures = picture('none', lamp), picture(change, lamp)
                errors, _, used = flip_evaluator.evaluate(*pictures, 'HDR' if lamp else 'LDR', inputsRGB=False,
                                                          applyMagma=False, parameters={'ppd': ppd})
                errors = errors.reshape(HEIGHT, WIDTH).astype(float)
                exposures = ''
                if lamp:
                    exposures = f' {used["startExposure"]:.6f}, {used["stopExposure"]:.6f}, {used["numExposures"]}'
                print(f'    {{"{change}", {ppd}, {errors.mean():.9f}, {errors[12, 46]:.6f}, {errors[40, 69]:.6f}}},'
                      f'{exposures}')


if __name__ == '__main__':
    main()
