"""The write-ups' claims as numbers: what a claim is, and where its renders come from; replay_claim_*.py make them."""
import dataclasses
import shlex
import subprocess

import numpy as np

import lanewise

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])

HOLDS, FAILS, CONDITION = 'Holds', 'Does not hold', 'Holds under a condition'


@dataclasses.dataclass
class Claim:
    quote: str  # of the write-ups
    verdict: str  # one of the three, and what the condition is
    says: str  # what was measured
    rule: str  # by which the verdict follows from the numbers
    head: list
    rows: list  # texts
    commands: list  # of the renders, with {} for what varies
    charts: list = dataclasses.field(default_factory=list)  # SVG

    def figures(self):
        """For JSON."""
        return {name: getattr(self, name) for name in ('quote', 'verdict', 'says', 'rule', 'head', 'rows', 'commands')}


class Lab:
    """Renders for claims, kept with the pictures: the same command line is rendered once."""

    def __init__(self, studio, place):
        self.studio, self.place = studio, place

    def scene(self, name, stand_in):
        return self.place.find(name, stand_in)

    def knows(self, flag):
        """Whether the program has it."""
        command = [lanewise.PROGRAM, 'render', '--help']
        return flag in subprocess.run(command, capture_output=True, text=True, check=True).stdout

    def render(self, scene, flags, samples):
        """Picture and record."""
        samples = min(samples, self.place.samples or samples)
        before = self.studio.rendered
        picture, record = self.studio.render(scene, *self.place.flags(scene), *shlex.split(flags), '-s', samples)
        if self.studio.rendered > before:
            print(f'{self.command(scene, flags, samples)}: {record["seconds"]:.3g} s', flush=True)
        return picture, record

    def command(self, scene, flags, samples):
        return ' '.join(['lanewise render', scene.name, *map(str, self.place.flags(scene)), flags, f'-s {samples}'])


def luminance(picture):
    return picture.astype(float) @ LUMINANCE


def figure_of(lab, scene):
    """Which pixels see metal that a light reaches: by direct light two metals differ there, and nothing else does."""
    silver, chromium = (lab.render(scene, f'-m 1 --alpha 0.5 --metal {metal}', 4)[0] for metal in ('Ag', 'Cr'))
    return (silver != chromium).any(2)
