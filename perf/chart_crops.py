"""Pictures for the page of `lanewise chart`: what each renderer makes of the same time, and in what time it comes to
the same error; cut out where errors are greatest, all at the exposure of `lanewise render`."""
import dataclasses

import numpy as np

import chart_summary
import picture_error
from page import encoded, to_srgb, uri

PARTS = 6  # a crop is a sixth of the picture's width and height
REGIONS = 2
COLOURS = [(250, 204, 21), (34, 211, 238)]  # of their frames
MOST = 4  # times the samples of a renderer's last rung are rendered for a picture


@dataclasses.dataclass
class Crop:
    name: str
    note: str  # samples, seconds, error
    images: list  # data URIs, one a region


@dataclasses.dataclass
class Comparison:
    title: str
    crops: list


def compare(store, subject, reference, renderers, curves):
    """The reference with its regions marked, as a data URI, and Comparisons: at equal time, at equal error."""
    anchor = next((c for c in curves if c.is_peer), None)
    rung = -1 if anchor else len(curves[0].samples) // 2
    anchor = anchor or curves[0]
    seconds, error = (of_rungs[rung] for of_rungs in anchor.means())
    what = f'{anchor.name} at {anchor.samples[rung]} samples'
    plans = [(f'What the same time gives: the {seconds:.3g} s of {what}', chart_summary.samples_in, seconds),
             (f'When the same error is reached: the MRSE of {error:.3g} of {what}', chart_summary.samples_for, error)]
    if len(curves) == 1:  # at the same error it is what it is at the same time
        plans = [(what, chart_summary.samples_in, seconds)]
    shots = []
    for title, samples_at, aim in plans:
        found = []
        for renderer, curve in zip(renderers, curves):
            samples = int(np.clip(round(samples_at(curve, aim)), 1, MOST * curve.samples[-1]))
            found.append((renderer.name, *store.picture(subject, reference, renderer, samples)))
        shots.append((title, found))
    regions = _worst_regions([picture for _, picture, _ in shots[0][1]], reference.picture)
    comparisons = []
    for title, found in shots:
        crops = [Crop(name, f'{point.samples} samples, {point.seconds:.3g} s, MRSE {point.mrse:.3g}',
                      [uri(encoded(to_srgb(picture[region]))) for region in regions]) for name, picture, point in found]
        truth = Crop('reference', f'{reference.samples} samples',
                     [uri(encoded(to_srgb(reference.picture[region]))) for region in regions])
        comparisons.append(Comparison(title, [truth, *crops]))
    marked = encoded(_marked(to_srgb(reference.picture), regions), 'jpeg', quality=92)
    return uri(marked, 'jpeg'), comparisons


def _worst_regions(pictures, reference):
    """Slices of rows and columns; no two overlap."""
    error = np.mean([picture_error.relative_squares(p, reference).mean(2) for p in pictures], 0)
    height, width = (max(1, n // PARTS) for n in error.shape)
    tops = range(0, error.shape[0] - height + 1, max(1, height // 2))
    lefts = range(0, error.shape[1] - width + 1, max(1, width // 2))
    by_error = sorted(((error[y:y + height, x:x + width].mean(), y, x) for y in tops for x in lefts), reverse=True)
    chosen = []
    for _, y, x in by_error:
        if len(chosen) < REGIONS and all(abs(y - v) >= height or abs(x - u) >= width for v, u in chosen):
            chosen.append((y, x))
    return [np.s_[y:y + height, x:x + width] for y, x in chosen]


def _marked(pixels, regions):
    for (rows, columns), colour in zip(regions, COLOURS):
        inner = pixels[rows, columns][2:-2, 2:-2].copy()
        pixels[rows, columns] = colour
        pixels[rows, columns][2:-2, 2:-2] = inner
    return pixels
