"""Charts of the claims: lines over one axis, in the style of `lanewise chart`."""
import matplotlib

from chart_draw import MARKERS, OURS, PEERS, STYLE
from study import plt
from svg_text import svg_text

COLOURS = [OURS[0], PEERS[0], OURS[1], OURS[2], PEERS[3], OURS[3], PEERS[1], PEERS[4]]


def lines(title, across, up, series, logs='', ticks=None):
    """series: {name: (x, y)}. logs: which axes are logarithmic. ticks: on the x axis. SVG text."""
    with matplotlib.rc_context(STYLE):
        figure, axis = plt.subplots(figsize=(5.2, 3.4))
        for k, (name, (x, y)) in enumerate(series.items()):
            axis.plot(x, y, color=COLOURS[k % len(COLOURS)], marker=MARKERS[k % len(MARKERS)], markersize=4,
                      linewidth=1.4, label=name)
        if 'x' in logs:
            axis.set_xscale('log')
        if 'y' in logs:
            axis.set_yscale('log')
        else:
            axis.set_ylim(bottom=0)
        if ticks is not None:
            axis.set_xticks(ticks, [f'{tick:g}' for tick in ticks])
            axis.minorticks_off()
        axis.set_xlabel(across)
        axis.set_ylabel(up)
        figure.suptitle(title, fontsize=10, fontweight='bold', x=0.02, ha='left')
        rows = 0
        if len(series) > 1:
            axis.legend(loc='lower left', bbox_to_anchor=(-0.02, 1), ncol=2, frameon=False, fontsize=8)
            rows = (len(series) + 1) // 2
        figure.subplots_adjust(left=0.15, right=0.97, bottom=0.15, top=0.92 - 0.055 * rows)
        return svg_text(figure)
