"""How far each departure of the course program moves the picture from the exact one."""
import numpy as np

import picture_error
from replay_claims import FAILS, HOLDS, Claim, luminance

BLOCK = 8  # pixels
DEPARTURES = {'masking': '--model course-masking', 'clamp of angles': '--model course-clamp',
              'Fresnel': '--fresnel course', 'direct light by hemisphere': '-H', 'all of --model course': '--model '
              'course'}
SCENES = {'CBdragon_microfacet_au': ('cornell_metal', '--alpha 0.5'), 'CBspheres': ('cornell_spheres', '')}
NOTICED = 0.01


def departures(lab):
    if not lab.knows('--model'):
        return None
    rows, commands, most = [], [], 0
    for name, (stand_in, own) in SCENES.items():
        scene = lab.scene(name, stand_in)
        base = f'-l 4 -m 5 {own}'.strip()
        exact, again = (lab.render(scene, base + seed, 64)[0] for seed in ('', ' --seed 1'))
        for departure, flags in DEPARTURES.items():
            if not own and departure in ('masking', 'clamp of angles'):
                continue  # of microfacets alone
            pair = [lab.render(scene, f'{base} {flags} --seed {seed}', 32)[0] for seed in (2, 3)]
            brighter = luminance(sum(pair)).mean() / luminance(exact + again).mean() - 1
            moved, unsure = _moved(pair, (exact, again))
            most = max(most, moved if departure == 'all of --model course' and moved > unsure else 0)
            rows.append([f'{scene.stem}: {departure}', f'{100 * brighter:+.2f}%'.replace('-', '−'),
                         f'{100 * moved:.2f}%' if moved > unsure else f'less than {100 * unsure:.2g}%'])
            commands.append(lab.command(scene, f'{base} {flags} --seed {{}}', 32))
    return Claim('The course program\'s formulas give the same picture', FAILS if most > NOTICED else HOLDS,
                 f'With all of them, blocks of {BLOCK} x {BLOCK} pixels move by {100 * most:.2g}% in the root mean '
                 'square.',
                 f'It holds if no scene moves by more than {100 * NOTICED:g}%. Relative differences of two '
                 'independent pairs of pictures '
                 'are multiplied, so that noise does not count; "less than" where they are within two standard errors '
                 'of 0.',
                 ['departure', 'mean', 'blocks move by'], rows, commands)


def _moved(pair, exact):
    """Root mean square of the relative difference of blocks, and what it must be above to be no noise's work."""
    (a, b), (c, d) = (tuple(map(_blocks, pictures)) for pictures in (pair, exact))
    products = (a - c) * (b - d) / ((c + d) / 2 + picture_error.FLOOR)**2
    return float(np.sqrt(max(0, products.mean()))), float(np.sqrt(2 * products.std() / np.sqrt(products.size)))


def _blocks(picture):
    bright = luminance(picture)
    height, width = (n // BLOCK for n in bright.shape)
    return bright[:height * BLOCK, :width * BLOCK].reshape(height, BLOCK, width, BLOCK).mean((1, 3))
