"""Whether two sets of independent renders have the same expectation.

Each renderer gives K pictures of n samples a pixel under K seeds. A pixel's value is heavy-tailed (caustics), and no
test of few numbers has an exact tail at the 1e-6 that Sidak's correction over 10^4 pixels asks for. What makes Welch's
t-test safe here is symmetry: both sides have the same K, n, transport and estimator, so that the difference is nearly symmetric
however skewed each side is, and on symmetric heavy tails the t-test errs on the side of accepting. (Mitsuba's strata
break the symmetry where they help, which is where tails are short.) It then says little about small errors in single
pixels; hence four tests, each of which must pass:

  pixels  Welch's t-test per pixel and channel, and on luminance; significance 0.01 over all pixels of a picture
          (Sidak), and 99.75% of them must pass, as in Mitsuba 3's own test_renders.py.
  shares  of the pixels' p-values below 0.05 (Jung, Hanika & Dachsbacher, JCGT 2020, look at their histogram): at most
          5% and four standard errors. An error of a third of a pixel's standard error, all over, shows here.
  blocks  Welch's t-test per 10 x 10 pixels on luminance, where means of 100 pixels are near normal; every block must
          pass at significance 0.01 over all blocks of all pictures of the table.
  means   of the picture, per channel: relative difference below 0.1%, its standard error printed beside it.

`validate` of unbiased.py measures what they find: halves of the same renderer against each other, and planted errors.
"""
import dataclasses

import numpy as np
from scipy import stats

SIGNIFICANCE = 0.01
PASSING_PIXELS = 0.9975
LOW_P = 0.05
BLOCK = 10
MEAN_TOLERANCE = 1e-3
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
ROUNDING = 2e-6  # relative: what sums of floats may differ by where no sample does


@dataclasses.dataclass
class Comparison:
    pixels: list  # share of pixels that pass, of luminance, R, G, B
    low_p: float  # share of luminance p-values below LOW_P
    low_p_limit: float
    worst_block: float  # its p-value, corrected over the blocks of all pictures
    difference: list  # of means R, G, B, relative to the second's
    error: list  # standard errors of these

    @property
    def verdicts(self):
        return {'pixels': min(self.pixels) >= PASSING_PIXELS, 'shares': self.low_p <= self.low_p_limit,
                'blocks': self.worst_block >= SIGNIFICANCE, 'means': max(map(abs, self.difference)) < MEAN_TOLERANCE}


def welch(a, b):
    """p-values of equal expectations of a[K, ...] and b[K, ...]."""
    mean_a, mean_b = a.mean(0), b.mean(0)
    v_a, v_b = a.var(0, ddof=1) / len(a), b.var(0, ddof=1) / len(b)
    floor = (ROUNDING * np.maximum(np.abs(mean_a), np.abs(mean_b))) ** 2 + 1e-30
    freedom = (v_a + v_b + floor) ** 2 / (v_a**2 / (len(a) - 1) + v_b**2 / (len(b) - 1) + floor**2 / 1e6)
    return 2 * stats.t.sf(np.abs(mean_a - mean_b) / np.sqrt(v_a + v_b + floor), freedom)


def sidak(tests):
    return -np.expm1(np.log1p(-SIGNIFICANCE) / tests)


def compare(a, b, a_more=None, pictures=1):
    """a, b: (K, height, width, 3), with the same samples a pixel. a_more: a with more samples or another estimator, for blocks
    and means.
    pictures: how many of them the table has."""
    a, b = a.astype(float), b.astype(float)
    a_more = a if a_more is None else a_more.astype(float)
    count = a.shape[1] * a.shape[2]
    luminance = welch(a @ LUMINANCE, b @ LUMINANCE)
    p = [luminance, *np.moveaxis(welch(a, b), -1, 0)]
    block_p = welch(*(_blocks(x @ LUMINANCE) for x in (a_more, b))).min()
    blocks = (a.shape[1] // BLOCK) * (a.shape[2] // BLOCK) * pictures
    mean_a, mean_b = a_more.mean((0, 1, 2)), b.mean((0, 1, 2))
    squares = _square_error(a_more) + _square_error(b)
    scale = np.maximum(mean_b, 1e-30)
    return Comparison(
        pixels=[float((x >= sidak(count)).mean()) for x in p],
        low_p=float((luminance < LOW_P).mean()),
        low_p_limit=float(LOW_P + 4 * np.sqrt(LOW_P * (1 - LOW_P) / count)),
        worst_block=float(-np.expm1(blocks * np.log1p(-min(block_p, 1 - 1e-16)))),
        difference=((mean_a - mean_b) / scale).tolist(),
        error=(np.sqrt(squares) / scale).tolist())


def _square_error(x):
    """Variance of the picture's mean. Blocks are independent, or nearly, and many of them tell it better than K means."""
    blocks = np.stack([_blocks(x[..., channel]) for channel in range(x.shape[-1])], -1)
    return blocks.var(0, ddof=1).mean((0, 1)) / len(x) / (blocks.shape[1] * blocks.shape[2])


def _blocks(x):
    k, height, width = x.shape
    return x.reshape(k, height // BLOCK, BLOCK, width // BLOCK, BLOCK).mean((2, 4))
