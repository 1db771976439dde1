"""The charts of `lanewise chart`: error against seconds of rendering, one scene and one measure each."""
import dataclasses
import math
import textwrap

import matplotlib
import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

import chart_summary
from study import plt
from svg_text import svg_text

OURS = ['#1b6ca8', '#0f766e', '#7c3aed', '#be123c', '#334155']  # full marks and lines
PEERS = ['#d95f02', '#65a30d', '#c026d3', '#b8860b', '#6b7280']  # hollow marks, broken lines
MARKERS = 'osD^v'
GREY = '#4b5563'
STYLE = {'svg.fonttype': 'none', 'font.size': 9, 'axes.edgecolor': GREY, 'grid.color': GREY, 'grid.alpha': 0.15}


@dataclasses.dataclass
class Kind:
    """What is drawn against what."""
    error: str
    against: str
    axis: str
    slopes: tuple = (-1, -1.5)  # what independent samples give, and what well spread ones may


# By the end of the charts' names.
KINDS = {'mrse': Kind('MRSE', 'seconds', 'seconds of rendering'),
         'flip': Kind('mean FLIP error', 'seconds', 'seconds of rendering', ()),  # it follows no power
         'samples': Kind('MRSE', 'samples', 'samples a pixel')}


def draw(scene, kind, curves, command, own_error=None, versus=None):
    """As SVG text. own_error: the reference's. versus: (curve, peer's curve), joined by an arrow at equal error."""
    with matplotlib.rc_context(STYLE):
        figure, axis = plt.subplots(figsize=(5.2, 4.2))
        axis.set_xscale('log')
        axis.set_yscale('log')
        front = chart_summary.pareto_front(curves)
        axis.plot(*zip(*front), color='#facc15', alpha=0.45, linewidth=9, solid_capstyle='round',
                  solid_joinstyle='round', label='Pareto front', zorder=1)
        for colours, group in ((OURS, [c for c in curves if not c.is_peer]), (PEERS, [c for c in curves if c.is_peer])):
            for k, c in enumerate(group):
                _draw_curve(axis, c, colours[k % len(colours)], MARKERS[k % len(MARKERS)])
        _set_limits(axis, curves)
        for slope in kind.slopes:
            _draw_guide(axis, slope)
        if own_error and own_error > axis.get_ylim()[0]:
            axis.axhline(own_error, color=GREY, linewidth=0.8, linestyle=':')
            axis.annotate('the reference\'s own error, taken off', (1, own_error), xycoords=('axes fraction', 'data'),
                          xytext=(0, -2), textcoords='offset points', ha='right', va='top', fontsize=7.5, color=GREY)
        if versus:
            _draw_arrow(axis, *versus)
        axis.set_xlabel(kind.axis)
        axis.set_ylabel(kind.error)
        title = f'{scene}: {kind.error} against {kind.against}'
        figure.suptitle(title, fontsize=10, fontweight='bold', x=0.02, ha='left')
        legend = axis.legend(loc='lower left', bbox_to_anchor=(-0.02, 1), ncol=2, frameon=False, fontsize=8.5)
        figure.text(0.99, 0.008, textwrap.shorten(command, 110, placeholder=' ...'), ha='right', fontsize=5, color=GREY)
        rows = math.ceil(len(legend.get_texts()) / 2)
        figure.subplots_adjust(left=0.13, right=0.96, bottom=0.14, top=0.93 - 0.045 * rows)
        return svg_text(figure)


def _draw_curve(axis, c, colour, marker):
    """With bars from the least to the largest of the seeds."""
    x, y = c.means()
    shown = y > 0
    bars = [[np.maximum(middle - values.min(1), 0)[shown], np.maximum(values.max(1) - middle, 0)[shown]]
            for middle, values in ((x, c.seconds), (y, c.error.clip(y[:, None] / 10)))]
    fill, line = ('white', '--') if c.is_peer else (colour, '-')
    axis.errorbar(x[shown], y[shown], xerr=bars[0], yerr=bars[1], label=c.name, color=colour, marker=marker,
                  markersize=4.5, markerfacecolor=fill, linestyle=line, linewidth=1.4, elinewidth=0.9, capsize=1.5,
                  zorder=3)


def _set_limits(axis, curves):
    """Whole powers would waste the room; so would a reference line far below."""
    x = [s for c in curves for s in c.seconds.ravel()]
    y = [e for c in curves for e in c.error.mean(1) if e > 0]
    axis.set_xlim(min(x) / 1.5, max(x) * 1.8)
    axis.set_ylim(min(y) / 2, max(y) * 2)
    for one, (low, high) in ((axis.xaxis, axis.get_xlim()), (axis.yaxis, axis.get_ylim())):
        one.set_major_locator(LogLocator(subs=[1, 2, 5] if high / low < 60 else [1]))
        one.set_major_formatter(_plain)
        one.set_minor_formatter(NullFormatter())


def _draw_guide(axis, slope):
    """In the lower left of the axes, which no curve passes."""
    (x0, x1), (y0, y1) = axis.get_xlim(), axis.get_ylim()
    wide, high = math.log10(x1 / x0), math.log10(y1 / y0)
    decades = min(0.2 * wide, 0.33 * high / abs(slope))
    left, top = x0 * 10**(0.03 * wide), y0 * 10**(0.42 * high)
    right, bottom = left * 10**decades, top * 10**(slope * decades)
    axis.plot([left, right], [top, bottom], color=GREY, linewidth=0.9, linestyle='--', zorder=2)
    # The labels keep clear of each other where the ends of the lines are near.
    axis.annotate(f'slope {slope:g}'.replace('-', '−'), (right, bottom), xytext=(3, 0), textcoords='offset points',
                  ha='left', va='top' if slope < -1 else 'bottom', fontsize=8, color=GREY)


def _draw_arrow(axis, c, peer):
    ratio, needed = chart_summary.times_sooner(c, peer)
    if needed.bound or not math.isfinite(ratio.value):
        return
    seconds, y = peer.last()
    axis.annotate('', (needed.value, y), (seconds, y), zorder=4,
                  arrowprops={'arrowstyle': '->', 'color': '#111827', 'linewidth': 1.1, 'shrinkA': 5, 'shrinkB': 3})
    axis.annotate(f'{ratio.value:.2g} × sooner', (math.sqrt(needed.value * seconds), y), xytext=(0, 4),
                  textcoords='offset points', ha='center', fontsize=9, fontweight='bold', zorder=5)


def _plain(value, _):
    """0.01, 10: no powers of ten to decode."""
    return f'{value:g}' if value >= 1e-4 else f'{value:.0e}'
