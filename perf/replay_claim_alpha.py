"""Darker and sharper at lower alpha: the figure's mean luminance, and how much of it is in neighbours' differences."""
import numpy as np

import replay_claim_draw
from replay_claims import CONDITION, FAILS, HOLDS, Claim, figure_of, luminance

ALPHAS = ['0.005', '0.05', '0.25', '0.5']
MODELS = {'exact': '', 'course': ' --model course'}


def darker_and_sharper(lab):
    scene = lab.scene('CBdragon_microfacet_au', 'cornell_metal')
    models = {name: flags for name, flags in MODELS.items() if not flags or lab.knows('--model')}
    figure = figure_of(lab, scene)
    bright = {name: [float(luminance(lab.render(scene, f'-l 4 -m 5 --alpha {alpha}{flags}', 64)[0])[figure].mean())
                     for alpha in ALPHAS] for name, flags in models.items()}
    sharp = []
    for alpha in ALPHAS:
        pair = (lab.render(scene, f'-l 4 -m 5 --alpha {alpha}{seed}', 64)[0] for seed in ('', ' --seed 1'))
        sharp.append(_sharpness(*pair, figure))
    exact = bright['exact']
    darker, sharper = _rises(exact), _rises(sharp[::-1])
    verdict = HOLDS if darker and sharper else FAILS if not darker and not sharper else (
        f'{CONDITION}: sharper, but not darker throughout' if sharper else f'{CONDITION}: darker, but not sharper '
        'throughout')
    ticks = [float(alpha) for alpha in ALPHAS]
    charts = [replay_claim_draw.lines('Mean luminance of the figure', 'alpha', 'luminance',
                                      {name: (ticks, found) for name, found in bright.items()}, logs='x', ticks=ticks)]
    rows = [[alpha, *(f'{found[k]:.4f}' for found in bright.values()), f'{sharp[k]:.3f}']
            for k, alpha in enumerate(ALPHAS)]
    course = f', by the course\'s formulas {_series(bright["course"])}' if 'course' in bright else ''
    return Claim('Lower alpha is darker and sharper', verdict,
                 f'The figure\'s mean luminance is {_series(exact)} at alpha {", ".join(ALPHAS)}{course}. Differences '
                 'between neighbouring '
                 f'pixels are {_series(sharp)} of it.',
                 'Darker: luminance rises with every step of alpha by the exact model. Sharper: the root mean square '
                 'difference of '
                 'neighbouring pixels over the mean falls with every step; from products of two independent renders, '
                 'so that noise '
                 'does not count.',
                 ['alpha', *(f'luminance, {name}' for name in bright), 'sharpness'], rows,
                 [lab.command(scene, f'-l 4 -m 5 --alpha {{}}{flags}', 64) for flags in models.values()], charts)


def _sharpness(a, b, figure):
    """Root mean square difference of neighbours in a row, over the mean."""
    inside = figure[:, 1:] & figure[:, :-1]
    a, b = luminance(a), luminance(b)
    squares = np.mean((np.diff(a, axis=1) * np.diff(b, axis=1))[inside])
    return float(np.sqrt(max(0, squares)) / a[figure].mean())


def _rises(values):
    return all(a < b for a, b in zip(values, values[1:]))


def _series(values):
    return ', '.join(f'{v:.3g}' for v in values)
