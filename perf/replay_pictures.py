"""Pictures made of pictures: labelled, animated, on a contact sheet. 8 bits of sRGB."""
import io

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from page import to_srgb

FRAME = (360, 270)  # of animations, in pixels
THUMBNAIL = (240, 180)
COLUMNS = 5
FONT = '/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf'


def animation(labelled, milliseconds):
    """An APNG of all (label, picture) in turn, the last longer."""
    frames = []
    for label, picture in labelled:
        frame = _image(picture).resize(FRAME, Image.Resampling.LANCZOS)
        _label(frame, label, 8, 8)
        frames.append(frame)
    file = io.BytesIO()
    durations = [milliseconds] * (len(frames) - 1) + [2 * milliseconds]
    frames[0].save(file, 'PNG', save_all=True, append_images=frames[1:], duration=durations, loop=0, optimize=True)
    return file.getvalue()


def contact_sheet(rendered):
    """All of them, a JPEG."""
    width, height = THUMBNAIL
    rows = -(-len(rendered) // COLUMNS)
    sheet = Image.new('RGB', (COLUMNS * (width + 8) + 8, rows * (height + 30) + 8), 'white')
    draw = ImageDraw.Draw(sheet)
    for k, r in enumerate(rendered):
        x, y = 8 + k % COLUMNS * (width + 8), 8 + k // COLUMNS * (height + 30)
        thumbnail = _image(r.picture)
        thumbnail.thumbnail(THUMBNAIL, Image.Resampling.LANCZOS)
        sheet.paste(thumbnail, (x, y))
        scene = r.shot.scene.stem.split('_')[0]
        draw.text((x, y + height + 3), f'{scene} {r.shot.label}', fill='#111827', font=_font(11))
    file = io.BytesIO()
    sheet.save(file, 'JPEG', quality=88)
    return file.getvalue()


def _image(linear):
    return Image.fromarray(np.ascontiguousarray(to_srgb(linear)), 'RGB')


def _label(image, text, x, y):
    draw = ImageDraw.Draw(image)
    font = _font(14)
    _, _, right, bottom = draw.textbbox((x, y), text, font=font)
    draw.rectangle([x - 4, y - 2, right + 4, bottom + 3], fill='#111827')
    draw.text((x, y), text, fill='white', font=font)


def _font(size):
    try:
        return ImageFont.truetype(FONT, size)
    except OSError:  # the one that Pillow brings along
        return ImageFont.load_default()
