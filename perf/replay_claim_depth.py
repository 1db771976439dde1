"""Claims about depth: where the light is, and how long paths last."""
import numpy as np

import replay_claim_draw
from replay_claims import CONDITION, FAILS, HOLDS, Claim, luminance

DEPTHS = [0, 1, 2, 3, 4, 5, 7, 10, 100]
SHOWN = [1, 2, 3, 5, 7]
SCENES = {'CBempty': None, 'CBspheres_lambertian': None, 'CBspheres_microfacet_al_ag': 'cornell_metal',
          'CBspheres': 'cornell_spheres', 'CBbunny': None, 'CBbunny_microfacet_cu': None, 'CBbunny_glass': None,
          'CBdragon_microfacet_au': None}
CLEAR = ('CBspheres', 'CBbunny_glass', 'cornell_spheres')  # with glass, that is
BLOCK = 12  # pixels


def _blocks(picture):
    bright = luminance(picture)
    height, width = (n // BLOCK * BLOCK for n in bright.shape)
    return bright[:height, :width].reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK).mean((1, 3))


def _reached(shares, share):
    return next(depth for depth, found in zip(DEPTHS, shares) if found >= share)


def depth_needed(lab):
    """The same paths at each depth, so that shares are exact but for what the last depth lacks."""
    scenes = {path.stem: path for name, stand_in in SCENES.items() if (path := lab.scene(name, stand_in))}
    shares, needed, rows = {}, {}, []
    for name, scene in scenes.items():
        blocks = [_blocks(lab.render(scene, f'-m {depth}', 4)[0]) for depth in DEPTHS]
        lit = blocks[-1] > 0.01 * blocks[-1].mean()
        shares[name] = [b.mean() / blocks[-1].mean() for b in blocks]
        worst = [np.quantile(b[lit] / blocks[-1][lit], 0.01) for b in blocks]
        needed[name] = _reached(shares[name], 0.99), _reached(worst, 0.9)
        rows.append([name, *(f'{100 * shares[name][DEPTHS.index(m)]:.1f}%' for m in SHOWN), *map(str, needed[name])])
    clear = [by_part for name, (_, by_part) in needed.items() if name in CLEAR]
    opaque = [by_part for name, (_, by_part) in needed.items() if name not in CLEAR]
    if not clear or not opaque:
        return None
    some = f'{CONDITION}: for some of the scenes' if max(clear) > max(opaque) else FAILS
    verdict = HOLDS if min(clear) > max(opaque) else some
    chart = replay_claim_draw.lines('Energy that is there at -m', '-m', 'share of the energy at -m 100',
                                    {name: (DEPTHS[:8], found[:8]) for name, found in shares.items()}, ticks=DEPTHS[:8])
    return Claim('The ray depth needed depends on the transmissive and reflective objects', verdict,
                 f'For 90% of the light in 99% of the picture, scenes with glass need -m {_span(clear)}, the others -m '
                 f'{_span(opaque)}. In the mean of the picture they differ little: what walls send each other decides.',
                 'It holds if every scene with glass needs more than any without. Needed: that 99% of the lit blocks '
                 f'of {BLOCK} x '
                 f'{BLOCK} pixels have 90% of what they have at -m 100.',
                 ['scene', *(f'energy at -m {m}' for m in SHOWN), '-m for 99% of it',
                  '-m for 90% in 99% of the picture'],
                 rows, [lab.command(scene, '-m {}', 4) for scene in scenes.values()], [chart])


def _span(values):
    return str(min(values)) if min(values) == max(values) else f'{min(values)} to {max(values)}'


def path_lengths(lab):
    scene = lab.scene('CBspheres', 'cornell_spheres')
    _, record = lab.render(scene, '-l 4 -m 1000', 64)
    paths = np.array(record['paths_by_length'], float)
    at_least = paths[::-1].cumsum()[::-1] / paths.sum()  # of paths of k events or more
    longest = int(np.nonzero(paths)[0][-1])
    # In the tail each event ends the same share of the paths.
    first, last = min(8, longest - 1), int(np.max(np.nonzero(at_least * paths.sum() >= 50)))
    keeps = (at_least[last] / at_least[first])**(1 / max(1, last - first))
    lasting = int(paths[100:].sum())
    seconds, rays = {100: [], 1000: []}, {}
    for seed in (1, 2, 3):
        for depth in (100, 1000):
            _, found = lab.render(scene, f'-m {depth} --seed {seed}', 16)
            seconds[depth].append(found['seconds'])
            rays[depth] = rays.get(depth, 0) + found['rays']
    more, time = rays[1000] / rays[100] - 1, min(seconds[1000]) / min(seconds[100])
    caught = (' They began where a sphere of glass touches the floor, nearer to it than the rounding of a ray\'s '
              'origin, and total internal reflection holds them inside.') if lasting else ''
    chart = replay_claim_draw.lines('Paths that last', 'scattering events', 'share of paths with as many or more',
                                    {scene.stem: (range(1, min(longest, 50) + 1), at_least[1:51])}, logs='y')
    steps = [k for k in (1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 100) if k <= longest]
    verdict = HOLDS if lasting < 1e-6 * paths.sum() else FAILS
    return Claim('It is hardly possible that a path lasts 100 bounces', verdict,
                 f'Of {paths.sum() / 1e6:.3g} million paths {lasting or "none"} had 100 scattering events or more.{caught} One in '
                 f'a hundred thousand had {int(np.argmax(at_least < 1e-5))} or more; in the tail {100 * keeps:.0f}% go on after each '
                 'event, for Russian roulette ends the others, without bias. '
                 f'-m 1000 has {100 * more:.3f}% more rays than -m 100, and took {time:.2f} of its time.',
                 'It holds if less than one path in a million has 100 events.',
                 ['events', 'share of paths with as many or more'], [[str(k), f'{at_least[k]:.3g}'] for k in steps],
                 [lab.command(scene, '-l 4 -m 1000', 64),
                  *(lab.command(scene, f'-m {m} --seed {{}}', 16) for m in (100, 1000))], [chart])
