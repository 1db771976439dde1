#!/usr/bin/python3
"""What features cost a scene that uses them, and one that does not: instructions for a sample, to perf/results/plan.md.

Callgrind counts what is executed within waves, from the camera to the film, on one thread: the same number in every run, on
a busy machine too. A box of diffuse surfaces is the base; each row changes one thing in its file or its flags. Needs Valgrind
(Debian: valgrind), which runs AVX2 at best.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import lanewise

WIDTH, HEIGHT, SAMPLES = 48, 36, 16
WAVES = 'lanewise::Wave::run(lanewise::Batch const&, lanewise::PixelSums*)'
FREE = {'unused': 0, 'unmet': 0.1}  # most instructions a sample that it may add
FLAGS = ['-r', WIDTH, HEIGHT, '-s', SAMPLES, '-t', 1, '--isa', 'avx2']

METAL = '''<effect id="metal-effect"><profile_COMMON><technique sid="common"><lambert/></technique></profile_COMMON>
<extra><technique profile="CGL">
  <microfacet><alpha>0.2</alpha><eta>1.1 0.8 0.6</eta><k>6.5 5.5 4.8</k></microfacet>
</technique></extra>
</effect>'''


def on_sphere(text, node, material):
    """The node's sphere made of another material."""
    return re.sub(rf'(<node id="{node}">.*?target=)"#\w+"', rf'\1"#{material}"', text, count=1, flags=re.S)


def diffuse_box():
    """cornell_spheres.dae with both spheres white, and without its other materials, which it has again as METAL and so on."""
    text = (lanewise.ROOT / 'scenes' / 'cornell_spheres.dae').read_text()
    for node in ('mirror-sphere', 'glass-sphere'):
        text = on_sphere(text, node, 'white')
    bare = text
    for name in ('mirror', 'glass'):
        bare = re.sub(rf'<effect id="{name}-effect">.*?</effect>', '', bare, flags=re.S)
        bare = re.sub(rf'<material id="{name}">.*?</material>', '', bare)
    metal = text.replace('</library_effects>', METAL + '</library_effects>').replace(
        '</library_materials>', '<material id="metal"><instance_effect url="#metal-effect"/></material></library_materials>')
    return bare, metal


def second_lamp(text):
    lamp = re.search(r'<node id="lamp">.*?</node>', text, re.S).group(0)
    return text.replace(lamp, lamp + lamp.replace('"lamp"', '"lamp-2"').replace('0 0 2.09', '0 0.8 2.08'))


def behind_the_wall(text, material):
    """One of the spheres, of this material, where no path comes; it is white in its place."""
    sphere = re.search(r'<node id="glass-sphere">.*?</node>', text, re.S).group(0)
    hidden = on_sphere(sphere, 'glass-sphere', material).replace('"glass-sphere"', '"hidden"').replace(
        '0.6 -0.35 0.4', '0.6 3 0.4')
    return text.replace(sphere, sphere + hidden)


def variants():
    """(what it is, file, flags, index of the row it is compared with, used or not)"""
    bare, declared = diffuse_box()
    return [
        ('diffuse box, pinhole, one lamp', bare, [], 0, 'base'),
        ('mirror, glass and metal in its library, on nothing', declared, [], 0, 'unused'),
        ('a lens: `-b 1e-6` in place of the pinhole', bare, ['-b', 1e-6, '-d', 5], 0, 'used'),
        ('`--normals smooth`, where no faces share a corner', bare, ['--normals', 'smooth'], 0, 'unused'),
        ('a white sphere more, behind the wall', behind_the_wall(declared, 'white'), [], 0, 'used'),
        ('the same of glass: a bin and a stage that no path meets', behind_the_wall(declared, 'glass'), [], 4, 'unmet'),
        ('one sphere a mirror', on_sphere(declared, 'mirror-sphere', 'mirror'), [], 0, 'used'),
        ('one sphere of glass', on_sphere(declared, 'mirror-sphere', 'glass'), [], 0, 'used'),
        ('one sphere of metal', on_sphere(declared, 'mirror-sphere', 'metal'), [], 0, 'used'),
        ('a second lamp', second_lamp(bare), [], 0, 'used'),
        ('`-m 4`: a bounce less, and no roulette', bare, ['-m', 4], 0, 'used'),
        ('all in trees: `--accel tree`', bare, ['--accel', 'tree'], 0, 'used'),
    ]


def count(scene, flags, folder):
    """{function: instructions of its own} within waves."""
    out = folder / 'callgrind.out'
    command = ['valgrind', '--tool=callgrind', f'--callgrind-out-file={out}', '--compress-pos=no', '--compress-strings=no',
               f'--toggle-collect={WAVES}', lanewise.PROGRAM, 'render', scene, '-q', '--no-estimate', '-f', folder / 'out.pfm',
               *FLAGS, *flags]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f'{" ".join(map(str, command))}: {done.stderr}')
    costs, function, inclusive = {}, None, False
    for line in out.read_text().splitlines():
        if line.startswith('fn='):
            function = line[3:]
        elif line.startswith('calls='):
            inclusive = True  # the next line is what the callee took
        elif line[:1].isdigit() and function:
            if not inclusive:
                costs[function] = costs.get(function, 0) + int(line.split()[1])
            inclusive = False
    return costs


def plan(scene, flags):
    command = [lanewise.PROGRAM, 'plan', scene, '-q', '--json', '/dev/stdout', *FLAGS, *flags]
    said = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True).stdout
    return json.loads(said)['plan']


def stages_left_out(scene, flags):
    return [d['subject'] for d in plan(scene, flags) if d['topic'] == 'stages' and d['choice'] == 'left out']


def executed_in(stages, costs):
    names = [''.join(part.capitalize() for part in stage.split('_')) for stage in stages]
    return sum(cost for function, cost in costs.items() if any(f'::{name}(' in function for name in names))


def measure(rows):
    """rows as variants() has them, their files by path or as text. Adds instructions a sample, and those in stages left out."""
    measured = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for what, scene, flags, base, kind in rows:
            if isinstance(scene, str) and scene.startswith('<'):
                (folder / 'box.dae').write_text(scene)
                scene = folder / 'box.dae'
            costs = count(scene, flags, folder)
            total = sum(costs.values())
            if not any('Intersect(' in function for function in costs):
                raise SystemExit('no kernel is seen: was the program stripped of its names?')
            left_out = stages_left_out(scene, flags)
            measured.append((what, kind, base, total / (WIDTH * HEIGHT * SAMPLES), len(left_out), executed_in(left_out, costs)))
            print(f'{what}: {measured[-1][3]:.1f}', file=sys.stderr)
    return measured


def table(measured):
    lines = ['| | feature is | instructions a sample | against | stages left out | instructions in them |',
             '|---|---|---|---|---|---|']
    for what, kind, base, cost, left_out, executed in measured:
        reference = measured[base][3]
        change = '' if kind == 'base' else f'{cost - reference:+.2f} ({100 * (cost / reference - 1):+.2f} %)'
        against = change + (f' to row {base + 1}' if base and change else '')
        lines.append(f'| {what} | {kind} | {cost:.1f} | {against} | {left_out} | {executed} |')
    return lines


def flag_rows(scenes):
    rows = []
    for scene in scenes:
        first, name = len(rows), pathlib.Path(scene).stem
        stored = next(d for d in plan(scene, ['--normals', 'smooth']) if d['subject'] == 'corner normals')
        smooth = 'unused' if stored['choice'] == 'none stored' else 'used'
        rows += [(name, scene, ['--normals', 'flat'], first, 'base'),
                 (f'{name}: `--normals smooth`', scene, ['--normals', 'smooth'], first, smooth),
                 (f'{name}: all in trees', scene, ['--normals', 'flat', '--accel', 'tree'], first, 'used')]
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--scenes', nargs='+', default=[*lanewise.SHIPPED, 'builtin:dense:20000'],
                        help='scenes for the second table; default: the shipped ones, and one of 20,000 triangles')
    arguments = parser.parse_args()
    if not shutil.which('valgrind'):
        raise SystemExit('valgrind is not there: apt-get install valgrind')
    box = measure(variants())
    scenes = measure(flag_rows(arguments.scenes))
    lines = ['# What features cost', '',
             f'Instructions within waves for a sample (camera to film, {WIDTH} x {HEIGHT} pixels, {SAMPLES} samples, depth 5, '
             'AVX2), counted by Callgrind:', 'the same in every run. Made by `perf/plan_costs.py`; '
             f'Lanewise {lanewise.version()}.', '',
             '*unused*: the file or the flags have the feature, nothing in the scene uses it: it must add 0. *unmet*: it is in the scene,',
             'but no path comes there: a check a bounce for an empty bin. *used*: what it costs a scene that wants it. The last columns',
             'are of the stages that `lanewise plan` says are left out: how many, and the instructions executed in their kernels.', '',
             *table(box), '', 'The same for whole scenes:', '', *table(scenes)]
    (lanewise.RESULTS / 'plan.md').write_text('\n'.join(lines) + '\n')
    print('\n'.join(lines))
    wrong = [row[0] for rows in (box, scenes) for row in rows
             if row[5] > 0 or abs(row[3] - rows[row[2]][3]) > FREE.get(row[1], float('inf'))]
    if wrong:
        raise SystemExit('not free of cost: ' + '; '.join(wrong))


if __name__ == '__main__':
    main()
