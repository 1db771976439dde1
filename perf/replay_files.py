"""The declarative files of `lanewise replay`, one for each topic (perf/replay/*.json): what is rendered, and what
it must show.

    {
      "title": "...", "about": "...",
      "scene": "CBspheres",                 a file of the scenes' folder, without .dae; or a path
      "stand_in": "cornell_spheres",        the shipped scene to take where that is not there; none: left out
      "sheets": [{
        "title": "...", "about": "...",     "scene" and "stand_in" may stand here instead
        "flags": "-l 4 -m 5",               of lanewise render, for all pictures of the sheet
        "sweep": ["-m 0", "-m 1"],          more flags: a picture for each
        "shows": {"-m 0": "The light."},    what these pictures must show
        "samples": [64],                    a pixel; "full_samples": with --full
        "rate": true,                       a picture of each picture's sample counts beside it
        "animation": 900                    one of all pictures, so many milliseconds each
      }]
    }
"""
import dataclasses
import json
import pathlib
import re
import shlex

import chart_renderers
import lanewise
from command import Problem

SAMPLES = [64]
TEXT, LIST, NUMBERS = (str, 'a text'), (list, 'a list'), (list, 'a list of whole numbers above 0')
OF_SHEET = {'title': TEXT, 'about': TEXT, 'scene': TEXT, 'stand_in': TEXT, 'flags': TEXT,
            'sweep': (list, 'a list of texts'), 'shows': (dict, 'an object of texts'), 'samples': NUMBERS,
            'full_samples': NUMBERS, 'rate': (bool, 'true or false'), 'animation': (int, 'a whole number')}
OF_TOPIC = {'title': TEXT, 'about': TEXT, 'scene': TEXT, 'stand_in': TEXT, 'sheets': LIST}
# Flags that the replay itself gives.
TAKEN = {'-s', '--spp', '-f', '--output', '--stats', '-r', '--resolution', '--view', '-q', '--quiet', '--rate', '-t',
         '--threads'}


@dataclasses.dataclass
class Shot:
    """A picture to be made."""
    name: str  # of its file
    scene: pathlib.Path
    flags: list
    label: str  # what sets it apart in its sheet
    shows: str
    rate: bool

    @property
    def command(self):
        """Without where files lie."""
        words = ['lanewise', 'render', self.scene.name, *map(str, self.flags), '-f', f'{self.name}.png']
        return shlex.join(words + (['--rate', f'{self.name}-rate.png'] if self.rate else []))


@dataclasses.dataclass
class Sheet:
    title: str
    about: str
    shots: list
    animation: int  # milliseconds a picture; 0: none


@dataclasses.dataclass
class Topic:
    title: str
    about: str
    sheets: list


@dataclasses.dataclass
class Place:
    """Where scenes are, and how large and with how many samples pictures are made."""
    scenes: pathlib.Path
    resolution: list
    full: bool = False
    samples: int | None = None  # in place of the files'

    def find(self, name, stand_in):
        """The scene; None where neither is there."""
        candidates = [self.scenes / f'{name}.dae', pathlib.Path(name), *([_shipped(stand_in)] if stand_in else [])]
        return next((path.resolve() for path in candidates if path.is_file()), None)

    def flags(self, scene):
        """That frame it. The scenes that we ship have cameras of their own."""
        found = [] if scene.parent == lanewise.ROOT / 'scenes' else ['--view', 'fit']
        return found + ([] if self.resolution == [480, 360] else ['-r', *self.resolution])


def read(path, place, notes):
    """A Topic. Adds to notes what is left out."""
    try:
        topic = json.loads(path.read_text())
    except (OSError, ValueError) as error:
        raise Problem(f'{path}: {getattr(error, "strerror", None) or error}') from None
    _check(path, topic, OF_TOPIC, 'the file')
    sheets = []
    for sheet in topic.get('sheets', []):
        _check(path, sheet, OF_SHEET, 'a sheet')
        if 'scene' not in sheet:
            sheet = {name: topic[name] for name in ('scene', 'stand_in') if name in topic} | sheet
        sheets.append(_sheet(path, sheet, place, notes))
    return Topic(topic['title'], topic.get('about', ''), [s for s in sheets if s.shots])


def _sheet(path, sheet, place, notes):
    where = f'{path}: "{sheet["title"]}"'
    if 'scene' not in sheet:
        raise Problem(f'{where}: has no "scene"')
    scene = place.find(sheet['scene'], sheet.get('stand_in'))
    found = Sheet(sheet['title'], sheet.get('about', ''), [], sheet.get('animation', 0))
    if not scene:
        notes.append(f'"{sheet["title"]}" is left out: {sheet["scene"]}.dae is not there.')
        return found
    samples = sheet.get('samples', SAMPLES)
    if place.full:
        samples = sheet.get('full_samples', samples)
    small = _shipped(sheet['stand_in']) if sheet.get('stand_in') else scene  # to try the flags on
    shows = sheet.get('shows', {})
    for flags in shows.keys() - set(sheet.get('sweep', [])):
        raise Problem(f'{where}: "shows" names "{flags}", which is not in "sweep"')
    for text in sheet.get('sweep', ['']):
        own = _flags(where, text)
        flags = _flags(where, sheet.get('flags', '')) + own
        chart_renderers.attempt(str(small), flags, f'{where}: {shlex.join(flags)}: ')
        for n in [place.samples] if place.samples else samples:
            varied = own + (['-s', n] if len(samples) > 1 or not own else [])
            slug = re.sub(r'[^a-z0-9.]+', '-', ' '.join(map(str, [scene.stem, *flags, 's', n])).lower()).strip('-')
            found.shots.append(Shot(slug, scene, place.flags(scene) + flags + ['-s', n], ' '.join(map(str, varied)),
                                    shows.get(text, ''), sheet.get('rate', False)))
    return found


def _shipped(name):
    return lanewise.ROOT / 'scenes' / f'{name}.dae'


def _flags(where, text):
    try:
        flags = shlex.split(text)
    except ValueError as error:
        raise Problem(f'{where}: {error}') from None
    for flag in flags:
        if flag in TAKEN:
            raise Problem(f'{where}: {flag} is for lanewise replay to choose')
    return flags


def _check(path, content, members, what):
    if not isinstance(content, dict):
        raise Problem(f'{path}: {what} is not an object')
    if 'title' not in content:
        raise Problem(f'{path}: {what} has no "title"')
    for name, value in content.items():
        if name not in members:
            raise Problem(f'{path}: {what} has an unknown member "{name}"; known are {", ".join(members)}')
        kind, words = members[name]
        good = isinstance(value, kind) and (kind is bool or not isinstance(value, bool))
        if members[name] is NUMBERS:
            good = good and value and all(isinstance(n, int) and n > 0 for n in value)
        if words.endswith('of texts'):
            good = good and value and all(isinstance(t, str) for t in (value.values() if kind is dict else value))
        if not good:
            raise Problem(f'{path}: "{name}" of {what} is not {words}')
