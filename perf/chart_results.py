"""What `lanewise chart` makes of a scene, and the files that it leaves."""
import csv
import dataclasses
import io
import json

import chart_crops
import chart_draw
import chart_page
import chart_store
import chart_summary
from command import Problem
from kept import OutOfTime, write as write_file
from svg_text import HEADER


def _measure(store, subject, reference, renderers, seeds):
    """All points, those of one seed and number of samples in turn."""
    points = []
    rungs = sorted({n for r in renderers for n in r.samples})
    try:
        for seed in range(chart_store.FIRST_SEED, chart_store.FIRST_SEED + seeds):
            for samples in rungs:
                points += [store.point(subject, reference, renderer, samples, seed)
                           for renderer in renderers if samples in renderer.samples]
    except OutOfTime:
        pass
    return points


def section_of(store, subject, args, renderers, command, notes):
    """Measures a scene and draws it; adds to the notes what is left out. Raises OutOfTime without anything to draw."""
    if not subject.camera and any(r.is_peer for r in renderers):
        notes.append(f'{subject.name}: other renderers are left out, for their reader cannot read this scene.')
        renderers = [r for r in renderers if not r.is_peer]
    reference = store.reference(subject, args.reference)
    points = _measure(store, subject, reference, renderers, args.seeds)
    curves, of_flip = ([c for renderer in renderers if (c := chart_summary.curve(renderer, points, what))]
                       for what in ('mrse', 'flip'))
    if not curves:
        raise OutOfTime
    if all((c.error.mean(1) <= 0).all() for c in curves):
        raise Problem(f'{subject.name}: all errors are lost in the reference\'s own; --reference takes more samples')

    def draw(kind, *what):
        return chart_draw.draw(subject.name, chart_draw.KINDS[kind], *what)
    charts = {'mrse': draw('mrse', curves, command, reference.mrse, chart_summary.duel(curves))}
    if of_flip:
        charts['flip'] = draw('flip', of_flip, command)
    if len(curves) > 1:
        charts['samples'] = draw('samples', chart_summary.by_samples(curves), command, reference.mrse)
    section = chart_page.Section(subject, reference, points, curves, charts)
    drawn = [r for r in renderers if any(c.name == r.name for c in curves)]
    try:
        section.picture, section.comparisons = chart_crops.compare(store, subject, reference, drawn, curves)
    except OutOfTime:
        pass
    return section


def write(out, sections, rendered, saved):
    """saved: what chart.json and the page say of the run."""
    out.mkdir(parents=True, exist_ok=True)
    for s in sections:
        for name, svg in s.charts.items():
            write_file(out / f'{s.subject.name}-{name}.svg', HEADER + svg)
    rows = [(s.subject.name, *dataclasses.astuple(p)) for s in sections for p in s.points]
    file = io.StringIO(newline='')
    csv.writer(file, lineterminator='\n').writerows(
        [('scene', *(f.name for f in dataclasses.fields(chart_store.Point))), *rows])
    write_file(out / 'chart.csv', file.getvalue())
    scenes = {s.subject.name: {
        'reference': {'samples': s.reference.samples, 'mrse': s.reference.mrse, 'seconds': s.reference.seconds},
        'says': chart_page.headline(s),
        'renderers': chart_summary.figures(s.curves, s.reference.mrse)} for s in sections}
    write_file(out / 'chart.json', json.dumps({**saved, 'scenes': scenes}, indent=1) + '\n')
    write_file(out / 'index.html', chart_page.page(sections, **saved))
    print(f'{out / "index.html"}: {sum(len(s.charts) for s in sections)} charts, {rendered} renders')
