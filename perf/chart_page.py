"""The page of `lanewise chart`: charts, tables and crops in one file that needs no other."""
import dataclasses
import html
import math

import chart_summary
from page import chart, document, picture, table

STYLE = """.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(460px, 100%), 1fr)); gap: 16px 24px; }
.charts > * { max-width: 620px; min-width: 0; } td b { white-space: nowrap; }
.charts svg, .reference img { width: 100%; height: auto; display: block; }
.charts > div { overflow-x: auto; } .charts th, .charts td { padding-right: 8px; }
.reference { max-width: 480px; margin-top: 1.5em; }
.crops { display: grid; grid-template-columns: repeat(auto-fill, minmax(150px, 1fr)); gap: 12px; }
.crops img { width: 100%; display: block; margin-bottom: 3px; image-rendering: pixelated; box-sizing: border-box; }
.crops img:nth-child(1) { border: 2px solid #facc15; } .crops img:nth-child(2) { border: 2px solid #22d3ee; }"""
NARROW = '.crops { grid-template-columns: repeat(2, minmax(0, 1fr)); }'


@dataclasses.dataclass
class Section:
    """A scene's."""
    subject: object
    reference: object
    points: list
    curves: list  # chart_summary.Curve of MRSE
    charts: dict  # {measure: SVG text}
    picture: str = ''  # the reference, as a data URI
    comparisons: list = dataclasses.field(default_factory=list)  # chart_crops.Comparison


def page(sections, versions, machine, command, notes):
    """versions: {renderer: its version and flags}. notes: lines about what is missing."""
    esc = html.escape
    first = sections[0].subject
    body = ['<p>Each mark is a number of samples a pixel, rendered with several seeds: their mean error and median '
            'seconds, with bars from the least to the largest. Lower and further left is better; no other renderer '
            'beats those on the yellow band in both. MRSE is the mean of (picture − reference)² / (reference + 0.01)²; '
            'the reference\'s own error is taken off.</p>',
            f'<p><code>{esc(command)}</code></p>',
            f'<p><small>{first.width} x {first.height} pixels, at most {first.depth} scattering events, flat normals, '
            f'{first.threads} threads of {esc(machine)}; seconds of rendering alone. '
            + '; '.join(esc(f'{name}: {version}') for name, version in versions.items()) + '.</small></p>']
    if any('flip' in s.charts for s in sections):
        body.append('<p><small>FLIP is the mean perceived difference from the reference, from 0 to 1; nothing is taken '
                    'off it.</small></p>')
    body += [f'<p><small>{esc(note)}</small></p>' for note in notes]
    body += [_section(s) for s in sections]
    return document('Lanewise: error against time', 'Error against seconds of rendering', body, STYLE, NARROW)


def headline(section):
    """What the scene's chart says, in a sentence; '' where there is no other renderer."""
    pair = chart_summary.duel(section.curves)
    if not pair:
        return ''
    best, peer = pair
    ratio, needed = chart_summary.times_sooner(best, peer)
    seconds, error = peer.last()
    of_peer = f'the error of {peer.name} with {peer.samples[-1]} samples (MRSE {error:.3g})'
    if needed.bound == '>':
        return f'{best.name} is not yet at {of_peer} with {best.samples[-1]} samples.'
    if needed.bound == '<':
        return f'{best.name} is below {of_peer} with {best.samples[0]}: more than {ratio.value:.3g} times sooner.'
    return f'{best.name} is at {of_peer} {estimate(ratio)} times sooner: in {estimate(needed)} s, not {seconds:.3g} s.'


def _section(s):
    reference = (f'Reference: Lanewise with {s.reference.samples} samples a pixel ({s.reference.seconds:.3g} s); '
                 f'its own MRSE is {s.reference.mrse:.2g}.')
    said = html.escape(headline(s), quote=False)
    lines = [f'<h2>{html.escape(s.subject.name)}</h2>', f'<p><b>{said}</b></p>' if said else '',
             '<div class="charts">',
             *map(chart, s.charts.values())]
    lines += [f'<div>{tables(s.curves, s.reference.mrse)}</div>', '</div>']
    if s.picture:
        lines.append(f'<figure class="reference">{picture(s.picture, "the reference")}<figcaption>{reference} The crops '
                     'below are from where the errors are greatest.</figcaption></figure>')
    else:
        lines.append(f'<p><small>{reference}</small></p>')
    for comparison in s.comparisons:
        lines += [f'<h3>{html.escape(comparison.title)}</h3><div class="crops">',
                  *(f'<figure>{"".join(picture(uri, crop.name) for uri in crop.images)}'
                    f'<figcaption><b>{html.escape(crop.name)}</b><br>{html.escape(crop.note)}</figcaption></figure>'
                    for crop in comparison.crops), '</div>']
    return '\n'.join(lines)


def tables(curves, reference_mrse):
    """What each renderer does in a second, and how much sooner ours are at the others' errors, as HTML."""
    rows = []
    for c in curves:
        slope, after = chart_summary.slope(c, reference_mrse), chart_summary.error_after(c, 1)
        rows.append([html.escape(c.name), f'{c.samples[-1] / c.last()[0]:.3g}', estimate(after), estimate(slope)])
    lines = [table(['', 'samples a pixel and second', 'MRSE after 1 s', 'MRSE ∝ samples to the'], rows)]
    ours, peers = [c for c in curves if not c.is_peer], [c for c in curves if c.is_peer]
    if ours and peers:
        rows = []
        for peer in peers:
            seconds, error = peer.last()
            cells = [f'{html.escape(peer.name)}, {peer.samples[-1]} samples', f'{error:.3g}', f'{seconds:.3g} s']
            for c in ours:
                ratio, needed = (html.escape(estimate(e)) for e in chart_summary.times_sooner(c, peer))
                cells.append(f'{needed} s: <b>{ratio} ×</b> sooner')
            rows.append(cells)
        lines.append(table(['the error of', 'MRSE', 'takes it', *(f'takes {c.name}' for c in ours)], rows))
    return '\n'.join(lines)


def estimate(e):
    """With its standard error, if that is known, to two of the error's digits."""
    if e is None or math.isnan(e.value):
        return '—'
    text = f'{e.value:.3g}'
    if e.error > 0 and e.bound not in ('<', '>'):
        places = max(0, 1 - math.floor(math.log10(e.error)))
        text = f'{e.value:.{places}f} ± {e.error:.{places}f}'
    return f'{e.bound} {text}'.strip().replace('-', '−')
