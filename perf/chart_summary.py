"""What points say together: a renderer's curve of error against seconds, its slope, and when it reaches another's
error. Of the seeds' errors the mean counts, and of their seconds the median: what else a machine does only ever adds to
a few. Between points curves are straight on logarithmic axes. Standard errors are the jackknife's, over seeds."""
import dataclasses
import math

import numpy as np


@dataclasses.dataclass
class Estimate:
    """error: standard error, NaN if unknown. bound: '' for a measured value, '>' where it is at least `value` ('<' at
    most), '≈' where it lies beyond the points."""
    value: float
    error: float = math.nan
    bound: str = ''


@dataclasses.dataclass
class Curve:
    """A renderer's points on a scene. Rungs ascend by samples."""
    name: str
    is_peer: bool
    samples: np.ndarray  # (rungs)
    seconds: np.ndarray  # (rungs, seeds)
    error: np.ndarray  # (rungs, seeds)

    @property
    def seeds(self):
        return np.arange(self.seconds.shape[1])

    def means(self, seeds=slice(None)):
        """Seconds and error of each rung."""
        return np.median(self.seconds[:, seeds], 1), self.error[:, seeds].mean(1)

    def last(self, seeds=slice(None)):
        """Seconds and error of the last rung."""
        return tuple(float(of_rungs[-1]) for of_rungs in self.means(seeds))

    def line(self, seeds=slice(None)):
        """log seconds, log error; rungs whose error drowns in the reference's are left out."""
        seconds, error = self.means(seeds)
        clear = self.error.mean(1) > 0
        return np.log(seconds[clear]), _log(error[clear])


def curve(renderer, points, measure):
    """Of the rungs that the first seed has, and the seeds that have all of these; None without any."""
    found = {(p.samples, p.seed): p for p in points if p.renderer == renderer.name and getattr(p, measure) is not None}
    seeds = sorted({seed for _, seed in found})
    if not seeds:
        return None
    samples = sorted(n for n, seed in found if seed == seeds[0])
    whole = [seed for seed in seeds if all((n, seed) in found for n in samples)]
    grid = [[found[n, seed] for seed in whole] for n in samples]
    seconds, error = ([[getattr(p, what) for p in row] for row in grid] for what in ('seconds', measure))
    return Curve(renderer.name, renderer.is_peer, np.array(samples), np.array(seconds), np.array(error))


def by_samples(curves):
    """Curves of error against samples a pixel, in place of seconds: what a sample is worth, whatever its price."""
    return [dataclasses.replace(c, seconds=c.samples[:, None] * np.ones(len(c.seeds))) for c in curves]


def jackknife(statistic, seeds):
    """statistic: of an array of indices of seeds."""
    value = statistic(seeds)
    if len(seeds) < 2:
        return Estimate(value)
    parts = np.array([statistic(np.delete(seeds, k)) for k in range(len(seeds))])
    return Estimate(value, float(np.sqrt((len(seeds) - 1) * parts.var())))


def slope(c, reference_mrse):
    """Of log error against log samples, least squares over the rungs whose error is above the reference's own; None
    with fewer than three."""
    clear = c.error.mean(1) > reference_mrse
    if clear.sum() < 3:
        return None
    x = np.log(c.samples[clear])

    def fit(seeds):
        return float(np.polyfit(x, _log(c.means(seeds)[1][clear]), 1)[0])
    return jackknife(fit, c.seeds)


def error_after(c, seconds):
    x, _ = c.line()
    if len(x) < 2:
        return None
    found = jackknife(lambda i: math.exp(_along(*c.line(i), math.log(seconds), -1)), c.seeds)
    found.bound = '' if x[0] <= math.log(seconds) <= x[-1] else '≈'
    return found


def samples_in(c, seconds):
    """How many samples a pixel take so long."""
    return math.exp(_along(np.log(c.means()[0]), np.log(c.samples), math.log(seconds), 1))


def samples_for(c, error):
    """How many samples a pixel leave that error."""
    return math.exp(_along(-_log(c.means()[1]), np.log(c.samples), -_log(error), 1))


def times_sooner(c, other):
    """The other's seconds for its last rung over those that c needs for the same error; and c's seconds."""
    seeds = np.arange(min(len(c.seeds), len(other.seeds)))

    def needed(i):
        return _seconds_to(c, i, _log(other.last(i)[1]))
    ratio = jackknife(lambda i: other.last(i)[0] / needed(i)[0], seeds)
    seconds, bound = needed(seeds)
    ratio.bound = {'<': '>', '>': '<'}.get(bound, '')
    return ratio, Estimate(seconds, bound=bound)


def duel(curves):
    """Our curve that is soonest at a peer's error, and the peer that it has the least lead on; None without both."""
    ours, peers = [c for c in curves if not c.is_peer], [c for c in curves if c.is_peer]
    if not ours or not peers:
        return None

    def lead(c, peer):
        ratio = times_sooner(c, peer)[0]
        return ratio.bound != '<', ratio.value  # one that is not yet there is behind all that are
    best = {peer.name: max(ours, key=lambda c: lead(c, peer)) for peer in peers}
    peer = min(peers, key=lambda p: lead(best[p.name], p))
    return best[peer.name], peer


def figures(curves, reference_mrse):
    """{name: what the table and the chart show}, for JSON."""
    def plain(estimate):
        return estimate and {k: v for k, v in dataclasses.asdict(estimate).items() if v == v}  # JSON has no NaN
    peers = [c for c in curves if c.is_peer]
    return {c.name: {
        'samples': c.samples.tolist(), 'seconds': c.means()[0].tolist(), 'mrse': c.means()[1].tolist(),
        'slope': plain(slope(c, reference_mrse)), 'mrse_after_1_s': plain(error_after(c, 1)),
        'times_sooner': {p.name: plain(times_sooner(c, p)[0]) for p in peers if p is not c}} for c in curves}


def pareto_front(curves):
    """(seconds, error) of the points that no other beats in both, by seconds."""
    points = sorted((s, e) for c in curves for s, e in zip(*c.means()) if e > 0)
    front = []
    for seconds, error in points:
        if not front or error < front[-1][1]:
            front.append((seconds, error))
    return front


def _seconds_to(c, seeds, log_error):
    """And '<' if the first rung is better already, '>' if the last is not yet as good: bounds, rather than guesses."""
    x, y = c.line(seeds)
    if not len(x):
        return math.nan, ''
    if y[0] <= log_error:
        return math.exp(x[0]), '<' if y[0] < log_error else ''
    for k in range(1, len(x)):
        if y[k] <= log_error:
            return math.exp(x[k - 1] + (x[k] - x[k - 1]) * (y[k - 1] - log_error) / (y[k - 1] - y[k])), ''
    return math.exp(x[-1]), '>'


def _along(x, y, at, slope):
    """Linear between the nearest two of x, which ascends but for noise; beyond its ends with the slope of independent
    samples, for two points of noisy times may have any."""
    x = np.maximum.accumulate(x)
    if at <= x[0] or at >= x[-1]:
        end = 0 if at <= x[0] else -1
        return y[end] + slope * (at - x[end])
    return np.interp(at, x, y)


def _log(error):
    """Of errors that may be 0 or less where the reference's own is taken off."""
    return np.log(np.maximum(error, 1e-30))
