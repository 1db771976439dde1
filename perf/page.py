"""Pages that need no other file, and what stands on them: tables, pictures. On narrow screens a table's rows become cards."""
import base64
import html
import io

import numpy as np
from matplotlib import image

TEMPLATE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>TITLE</title><style>
body { font: 16px/1.5 system-ui, sans-serif; color: #111827; background: #fff; }
body { max-width: 1240px; margin: 0 auto; padding: 16px; }
h1 { font-size: 1.6em; line-height: 1.2; margin: .3em 0; } h2 { font-size: 1.25em; margin: 2em 0 .3em; }
h3 { font-size: 1em; margin: 1.6em 0 .5em; } p { max-width: 75ch; margin: .5em 0; }
code { font: .85em/1.5 ui-monospace, monospace; background: #f3f4f6; padding: 2px 5px; overflow-wrap: anywhere; }
figure { margin: 0; min-width: 0; } figcaption, small { font-size: .8em; color: #4b5563; line-height: 1.35; }
table { border-collapse: collapse; margin: 0 0 1.5em; font-size: .9em; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: 5px 14px 5px 0; border-bottom: 1px solid #e5e7eb; vertical-align: top; }
th { font-weight: 600; vertical-align: bottom; max-width: 9em; } th:first-child, td:first-child { text-align: left; }
STYLE
@media (max-width: 720px) {
  thead { display: none; } table, tbody, tr { display: block; } table { width: 100%; }
  tr { border-bottom: 1px solid #d1d5db; padding: 6px 0; }
  td, td:first-child { display: flex; justify-content: space-between; gap: 16px; border: 0; padding: 1px 0; }
  td::before { content: attr(data-label); color: #4b5563; text-align: left; }
  td:first-child { display: block; font-weight: 600; }
  td:first-child::before { margin-right: .4em; font-weight: normal; } td > span { text-align: right; }
  NARROW
}
</style></head><body>
<h1>HEADING</h1>
BODY
</body></html>
"""


def document(title, heading, body, style, narrow=''):
    """body: its lines, HTML. style, narrow: CSS for all windows and for narrow ones."""
    filled = TEMPLATE.replace('TITLE', html.escape(title)).replace('HEADING', html.escape(heading))
    return filled.replace('STYLE', style).replace('NARROW', narrow).replace('BODY', '\n'.join(body))


def table(head, rows):
    """Cells are HTML, heads are text."""
    head = [html.escape(h) for h in head]
    body = (''.join(f'<td data-label="{h}"><span>{cell}</span></td>' for h, cell in zip(head, row)) for row in rows)
    return ('<table><thead><tr>' + ''.join(f'<th>{h}</th>' for h in head) + '</tr></thead><tbody>'
            + '\n'.join(f'<tr>{cells}</tr>' for cells in body) + '</tbody></table>')


def picture(uri, name):
    return f'<img src="{uri}" alt="{html.escape(name)}">'


def chart(svg):
    return f'<figure class="chart">{svg.replace("<svg", "<svg role=" + chr(34) + "img" + chr(34), 1)}</figure>'


def to_srgb(linear):
    """8 bits, as core/image_io.cc writes them."""
    x = np.clip(linear, 0, 1)
    x = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x**(1 / 2.4) - 0.055)
    return (255 * x + 0.5).astype(np.uint8)


def encoded(pixels, kind='png', **options):
    """The file's bytes. options: Pillow's."""
    file = io.BytesIO()
    image.imsave(file, np.ascontiguousarray(pixels), format=kind, pil_kwargs=options)
    return file.getvalue()


def uri(content, kind='png'):
    """Of a file's bytes."""
    return f'data:image/{kind};base64,' + base64.b64encode(content).decode()
