"""What has been rendered, kept in a cache folder: one small file for each render, written when it is done, so that a run
which is cut short goes on where it was. A file's name ends in a hash of all that its content hangs on."""
import hashlib
import json
import os
import pathlib
import re
import time

import numpy as np


class OutOfTime(Exception):
    """The next render would begin after the deadline."""


class Kept:
    def __init__(self, folder, deadline=float('inf')):
        """deadline: a value of time.monotonic()."""
        self.folder, self.deadline = folder, deadline
        self.rendered, self.cut_short = 0, False  # in this run
        folder.mkdir(parents=True, exist_ok=True)

    def path(self, name, identity):
        """Of a record; what belongs to it has other suffixes."""
        slug = re.sub(r'[^a-z0-9]+', '-', name.lower()).strip('-')
        return self.folder / f'{slug}-{digest(identity)}.json'

    def record(self, path, make):
        """make() gives it, as a dict, where it is not kept; what belongs to it must be written before it returns."""
        if path.exists():
            return json.loads(path.read_text())
        if time.monotonic() > self.deadline:
            self.cut_short = True
            raise OutOfTime
        record = make()
        self.rendered += 1
        write(path, json.dumps(record))
        return record


def default_folder(command):
    return pathlib.Path(os.environ.get('XDG_CACHE_HOME') or pathlib.Path.home() / '.cache') / 'lanewise' / command


def write(path, content):
    """Text, bytes, or an array as .npy; whole or not at all."""
    part = path.with_name(f'{path.name}.{os.getpid()}.part')
    with open(part, 'wb') as file:
        if isinstance(content, str):
            file.write(content.encode())
        elif isinstance(content, bytes):
            file.write(content)
        else:
            np.save(file, content)
    part.rename(path)


def half(picture):
    """To be kept: half precision is finer than a screen."""
    return np.minimum(picture, 6e4).astype(np.float16)


def digest(identity):
    return hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest()[:12]
