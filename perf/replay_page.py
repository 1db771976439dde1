"""The page of `lanewise replay`: a section a topic, a contact sheet a sheet, and the claims."""
import html

import page
from replay_pictures import animation

STYLE = """.sheet { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(270px, 100%), 1fr)); }
.sheet { gap: 20px 16px; }
.sheet img { width: 100%; height: auto; display: block; margin-bottom: 4px; background: #000; }
.sheet b { color: #111827; } figcaption span { display: block; margin: 2px 0; } .sheet code { padding: 1px 3px; }
.evidence { display: flex; flex-wrap: wrap; gap: 8px 32px; align-items: flex-start; } .evidence > * { min-width: 0; }
.chart { flex: 1 1 300px; max-width: 520px; } .chart svg { width: 100%; height: auto; display: block; }
.verdict { font-weight: 600; } nav a { margin-right: 1em; color: #1b6ca8; }"""
QUALITY = {'quality': 90}


def page_of(topics, claims, command, machine, version, notes):
    """topics: [(Topic, {name of a shot: Rendered})]. claims: replay_claim.Claim."""
    esc = html.escape
    links = [(f'topic-{k}', topic.title) for k, (topic, _) in enumerate(topics)]
    if claims:
        links.append(('claims', 'Claims'))
    body = ['<p>Every picture that the write-ups of the course\'s path tracer show, rendered by Lanewise, and their '
            'claims as numbers. Noise is the estimated MRSE: the mean of (picture − truth)² / (truth + 0.01)².</p>',
            f'<p><code>{esc(command)}</code></p>', f'<p><small>{esc(version)}; {esc(machine)}.</small></p>',
            *(f'<p><small>{esc(note)}</small></p>' for note in notes),
            '<nav>' + ' '.join(f'<a href="#{anchor}">{esc(title)}</a>' for anchor, title in links) + '</nav>']
    for (topic, rendered), (anchor, _) in zip(topics, links):
        body.append(f'<h2 id="{anchor}">{esc(topic.title)}</h2>')
        if topic.about:
            body.append(f'<p>{esc(topic.about)}</p>')
        for sheet in topic.sheets:
            body += _sheet(sheet, [(shot, rendered[shot.name]) for shot in sheet.shots])
    if claims:
        body += ['<h2 id="claims">Claims of the write-ups, as numbers</h2>', *(_claim(claim) for claim in claims)]
    return page.document('Lanewise: the write-ups, replayed', 'The write-ups, replayed', body, STYLE)


def caption(r):
    """What a render took, and how noisy it is."""
    noise = f'; noise {r.mrse["value"]:.2g} ({r.mrse["low"]:.2g} to {r.mrse["high"]:.2g})' if r.mrse else ''
    samples = f'{r.samples_per_pixel:.3g} samples a pixel, '
    millions = r.rays / 1e6
    return f'{samples}{r.seconds:.3g} s; {millions:.3g} million rays, {millions / r.seconds:.3g} million/s{noise}'


def _sheet(sheet, rendered):
    """rendered: [(Shot, Rendered)]; another sheet's shot may be the same picture."""
    lines = [f'<h3>{html.escape(sheet.title)}</h3>']
    if sheet.about:
        lines.append(f'<p>{html.escape(sheet.about)}</p>')
    lines.append('<div class="sheet">')
    for shot, r in rendered:
        content = page.encoded(page.to_srgb(r.picture), 'jpeg', **QUALITY)
        lines.append(_card(page.uri(content, 'jpeg'), shot.label, shot.shows, shot.command, caption(r)))
        if r.rate:
            lines.append(_card(page.uri(r.rate), f'{shot.label}: samples', 'How many samples each pixel took.', '',
                               f'{r.samples_per_pixel:.3g} samples a pixel in the mean'))
    if sheet.animation and len(rendered) > 1:
        frames = [(shot.label, r.picture) for shot, r in rendered]
        lines.append(_card(page.uri(animation(frames, sheet.animation)), 'All in turn', 'An animation (APNG).', '', ''))
    return lines + ['</div>']


def _card(uri, label, shows, command, figures):
    esc = html.escape
    parts = [f'<b>{esc(label)}</b>', *(esc(text) for text in (shows,) if text),
             *(f'<code>{esc(text)}</code>' for text in (command,) if text), *(esc(text) for text in (figures,) if text)]
    return (f'<figure>{page.picture(uri, label)}<figcaption>' + ''.join(f'<span>{part}</span>' for part in parts)
            + '</figcaption></figure>')


def _claim(claim):
    esc = html.escape
    return '\n'.join([f'<h3>“{esc(claim.quote)}”</h3>',
                      f'<p class="verdict">{esc(claim.verdict)}.</p>', f'<p>{esc(claim.says)}</p>',
                      f'<p><small>Rule: {esc(claim.rule)}</small></p>', '<div class="evidence">',
                      *(page.chart(svg) for svg in claim.charts), page.table(claim.head, claim.rows), '</div>',
                      *(f'<p><code>{esc(command)}</code></p>' for command in claim.commands)])
