#!/usr/bin/python3
"""Draws what the stability tests measured: for each failure mode a chart of error against the parameter that breaks it.

    perf/stability_page.py                      # runs build/lanewise_tests -ts=stability, takes some seconds
    perf/stability_page.py --curves lines.json  # draws an earlier run's LANEWISE_STABILITY_CURVES

Writes perf/results/stability.html, which needs no other file, and its charts perf/results/stability/<name>.svg.
"""

import argparse
import html
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import textwrap

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)

from svg_text import HEADER, svg_text  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
STYLES = {
    "naive": {"color": "#c2410c", "marker": "o", "linestyle": "--"},
    "ours": {"color": "#1d4ed8", "marker": "s", "linestyle": "-"},
}
# Text stays text: a sixth of the size. It is laid out for a wide font, so a narrower one fits too.
plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "lanewise", "font.size": 9, "axes.grid": True,
                     "grid.color": "#e5e7eb", "axes.axisbelow": True, "axes.edgecolor": "#6b7280",
                     "axes.spines.top": False, "axes.spines.right": False})


def run_tests(tests):
    """The lines that the tests append to the file named in the environment."""
    with tempfile.TemporaryDirectory() as folder:
        lines = pathlib.Path(folder) / "curves.json"
        environment = {"LANEWISE_SOURCE_DIR": str(ROOT), "LANEWISE_BINARY": str(tests.parent / "lanewise"), **os.environ,
                       "LANEWISE_STABILITY_CURVES": str(lines)}
        result = subprocess.run([tests, "-ts=stability"], env=environment, stdout=subprocess.PIPE, text=True, check=False)
        if result.returncode != 0:
            sys.exit(result.stdout + f"{tests}: a stability test failed; nothing drawn")
        return lines.read_text(encoding="utf-8")


def read_curves(text):
    """One curve a line, the last of each name; errors that are null (infinite or NaN) become inf."""
    curves = {}
    for line in text.splitlines():
        curve = json.loads(line)
        points = [(x, *(math.inf if error is None else error for error in errors)) for x, *errors in curve["points"]]
        curve["x"] = [point[0] for point in points]
        curve["errors"] = {"naive": [point[1] for point in points], "ours": [point[2] for point in points]}
        curves[curve["name"]] = curve
    return [curves[name] for name in sorted(curves)]


def log_range(curve):
    """Limits of a log axis of errors, with room at either end for those that it cannot show: 0 and infinity."""
    errors = [e for form in curve["errors"].values() for e in form]
    shown = [e for e in errors if 0 < e < math.inf] or [1]
    lowest, highest = math.floor(math.log10(min(shown))), math.ceil(math.log10(max(shown)))
    lowest = min(lowest, highest - 3)
    decades = highest - lowest
    floor = 10.0 ** (lowest - 0.12 * decades) if 0 in errors else None
    ceiling = 10.0 ** (highest + 0.12 * decades) if math.inf in errors else None
    return 10.0 ** lowest, 10.0 ** highest, floor, ceiling


def mark_limit(axes, y, text):
    axes.axhline(y, color="#6b7280", linewidth=0.8, linestyle=":")
    axes.annotate(text, (1, y), xycoords=("axes fraction", "data"), xytext=(2, 0), textcoords="offset points",
                  va="center", fontsize=7.5, color="#4b5563")


def draw(curve):
    """The chart as SVG text."""
    figure, axes = plt.subplots(figsize=(5.0, 3.7), layout="constrained")
    low, high, floor, ceiling = log_range(curve)
    axes.set_yscale("log")
    if curve["log_x"]:
        axes.set_xscale("log")
    for form, errors in curve["errors"].items():
        style = STYLES[form]
        y = [floor if e == 0 else ceiling if e == math.inf else e for e in errors]
        axes.plot(curve["x"], y, linewidth=1.5, markersize=3.2, label=textwrap.fill(f"{form}: {curve[form]}", 60),
                  zorder=3, **style)
        # What the axis cannot show is drawn hollow, at its end.
        ends = [(x, v) for x, v, e in zip(curve["x"], y, errors) if e in (0, math.inf)]
        if ends:
            axes.plot(*zip(*ends), linestyle="none", marker=style["marker"], markersize=5, markerfacecolor="white",
                      markeredgecolor=style["color"], zorder=4)
    if floor:
        mark_limit(axes, floor, "exactly 0")
    if ceiling:
        mark_limit(axes, ceiling, "infinite")
    axes.set_ylim((floor or low) / 1.5, (ceiling or high) * 1.5)
    axes.set_yticks([t for t in axes.get_yticks() if low <= t * 1.0001 and t <= high * 1.0001])
    axes.yaxis.set_minor_locator(matplotlib.ticker.NullLocator())
    axes.set_xlabel(textwrap.fill(curve["x_axis"], 66))
    axes.set_ylabel(textwrap.fill(curve["y_axis"], 38))
    title = textwrap.fill(curve["title"], 62)
    figure.suptitle(title, fontsize=10, fontweight="bold", x=0.01, ha="left")
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1), frameon=False, fontsize=8.5, handlelength=2.6)
    return svg_text(figure)


def number(value):
    """As HTML."""
    if value == 0:
        return "exactly 0"
    if math.isinf(value):
        return "infinite"
    if 0.001 <= value < 10000:
        return f"{value:.3g}" if value < 1000 else f"{value:.0f}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}·10<sup>{str(int(exponent)).replace('-', '−')}</sup>"


def worst(curve, form):
    """The largest error and the x where it is."""
    return max(zip(curve["errors"][form], curve["x"]))


def sentence(curve):
    (naive, x), (ours, _) = worst(curve, "naive"), worst(curve, "ours")
    return (f"<span class='naive'>Naive: up to {number(naive)}, at x = {number(x)}.</span> "
            f"<span class='ours'>Ours: {'' if ours == 0 else 'at most '}{number(ours)}.</span>")


def page(curves, charts):
    rows = "".join(
        f"<tr><td><a href='#{c['name']}'>{html.escape(c['title'])}</a><br><small>{html.escape(c['y_axis'])}</small></td>"
        f"<td class='naive'>{number(worst(c, 'naive')[0])}</td><td class='ours'>{number(worst(c, 'ours')[0])}</td></tr>"
        for c in curves)
    figures = "".join(
        f"<figure id='{c['name']}'>{chart.replace('<svg', '<svg role=' + chr(39) + 'img' + chr(39), 1)}"
        f"<figcaption>{sentence(c)}</figcaption></figure>" for c, chart in zip(curves, charts))
    return TEMPLATE.replace("ROWS", rows).replace("FIGURES", figures).replace("MODES", str(len(curves)))


TEMPLATE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Lanewise: stability</title><style>
body { font: 16px/1.45 system-ui, sans-serif; color: #111827; margin: 0 auto; padding: 12px; max-width: 1300px; }
h1 { font-size: 1.5em; margin: .4em 0; } p { max-width: 75ch; } code { background: #f3f4f6; padding: 1px 4px; }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(360px, 100%), 1fr)); gap: 16px; }
figure { margin: 0; padding: 8px; border: 1px solid #e5e7eb; border-radius: 6px; }
figure svg { width: 100%; height: auto; } figcaption { font-size: .85em; }
table { border-collapse: collapse; margin: 1em 0; font-size: .9em; }
th, td { text-align: left; padding: 3px 10px 3px 0; border-bottom: 1px solid #e5e7eb; vertical-align: top; }
td.naive, td.ours { white-space: nowrap; } small { color: #4b5563; }
.naive { color: #c2410c; } .ours { color: #1d4ed8; } a { color: inherit; }
</style></head><body>
<h1>Where these methods fail, and how far Lanewise is off there</h1>
<p>Each chart takes one way in which path tracers go wrong and shows the error against the parameter that brings it out:
of the <b class="naive">naive</b> form, and of the form in <b class="ours">ours</b>, which is the shipping code run on every
instruction set at hand (the worst of them counts). The tests check the same numbers. Axes of errors are logarithmic;
hollow marks at their ends stand for an error of exactly 0 and for an infinite one.</p>
<p>Drawn by <code>perf/stability_page.py</code> from <code>build/lanewise_tests -ts=stability</code>;
x in the captions is the chart's horizontal axis.</p>
<table><thead><tr><th>MODES charts of 19 failure modes, and the error measured</th><th class="naive">naive, worst</th>
<th class="ours">ours, worst</th></tr></thead><tbody>ROWS</tbody></table>
<main>FIGURES</main></body></html>
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tests", type=pathlib.Path, default=ROOT / "build/lanewise_tests", help="the test program")
    parser.add_argument("--curves", type=pathlib.Path, help="draw this file of curves rather than run the tests")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "perf/results", help="folder for the page")
    arguments = parser.parse_args()
    text = arguments.curves.read_text(encoding="utf-8") if arguments.curves else run_tests(arguments.tests)
    curves = read_curves(text)
    charts = [draw(curve) for curve in curves]
    folder = arguments.out / "stability"
    folder.mkdir(parents=True, exist_ok=True)
    for curve, chart in zip(curves, charts):
        (folder / f"{curve['name']}.svg").write_text(HEADER + chart, encoding="utf-8")
    result = arguments.out / "stability.html"
    result.write_text(page(curves, charts), encoding="utf-8")
    print(f"{result}: {len(curves)} charts, {result.stat().st_size / 1024:.0f} KiB")


if __name__ == "__main__":
    main()
