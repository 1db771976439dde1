"""How far a picture is from its reference: the measures of `lanewise compare`."""
import json
import pathlib
import subprocess
import tempfile

import numpy as np

import lanewise

FLOOR = 0.01  # of the relative error, as in core/image_compare.cc


def relative_squares(picture, reference):
    """(a - r)^2 / (r + 0.01)^2, of every pixel and channel, in double precision."""
    a, r = picture.astype(float), reference.astype(float)
    return ((a - r) / (r + FLOOR))**2


def mrse(picture, reference):
    return float(relative_squares(picture, reference).mean())


def program_has_flip():
    said = subprocess.run([lanewise.PROGRAM, 'compare', '--help'], capture_output=True, text=True, check=False).stdout
    return '--metric' in said and 'flip' in said


def flip(picture, reference):
    """Mean FLIP error (Andersson et al. 2020), 0 to 1, by the program."""
    return compare(picture, reference, '--metric', 'flip')['flip']


def compare(picture, reference, *flags):
    """What `lanewise compare --json` says."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [pathlib.Path(folder) / name for name in ('a.pfm', 'b.pfm')]
        for path, pixels in zip(paths, (picture, reference)):
            lanewise.write_pfm(path, pixels)
        command = [lanewise.PROGRAM, 'compare', *paths, '--json', *flags]
        return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
