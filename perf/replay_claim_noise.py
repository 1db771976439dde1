"""Claims about noise: specks at small alpha, and what importance sampling is worth."""
import numpy as np

import picture_error
from replay_claims import CONDITION, FAILS, HOLDS, Claim, figure_of, luminance

ALPHAS = ['0.005', '0.05', '0.5']
SEEDS = 3
SPECK = 4  # times what is there


def specks(picture, reference):
    """Which pixels are brighter than white and than four times all of the 3 x 3 of the reference around them."""
    bright = luminance(picture)
    around = np.lib.stride_tricks.sliding_window_view(np.pad(luminance(reference), 1, mode='edge'), (3, 3))
    return (bright > 1) & (bright > SPECK * around.max((2, 3)))


def fireflies(lab):
    scene = lab.scene('CBdragon_microfacet_au', 'cornell_metal')
    figure = figure_of(lab, scene)
    ways = {'light samples alone': ' --direct light', 'MIS (our default)': ''}
    references = [lab.render(scene, f'-m 5 --alpha {alpha} --seed 1001', 256)[0] for alpha in ALPHAS]
    found = {name: [specks(lab.render(scene, f'-l 4 -m 5 --alpha {alpha}{flags}', 64)[0], reference)
                    for alpha, reference in zip(ALPHAS, references)] for name, flags in ways.items()}
    light, mis = ([int(s.sum()) for s in of_way] for of_way in found.values())
    on_light, on_mis = ([int(s[figure].sum()) for s in of_way] for of_way in found.values())

    def appear(counts):
        return max(counts[:-1]) > 10 * max(1, counts[-1])
    verdict = (HOLDS if appear(light) and appear(mis) else
               f'{CONDITION}: where direct light is sampled at the lights alone' if appear(light) else FAILS)
    rows = [list(map(str, row)) for row in zip(ALPHAS, light, on_light, mis, on_mis)]
    return Claim('Bright specks appear at small alpha', verdict,
                 f'At alpha {", ".join(ALPHAS)} light samples alone leave {_series(light)} specks, MIS at the same '
                 'number of samples '
                 f'{_series(mis)}. On the metal itself, where its lobes meet the lights, these are '
                 f'{_series(on_light)} and '
                 f'{_series(on_mis)}; the others are light that the metal throws on the walls.',
                 f'A speck is a pixel that is brighter than white and than {SPECK} times all of the 3 x 3 around it '
                 'in a picture of 256 '
                 f'samples. They appear where a smaller alpha has over ten times as many as alpha {ALPHAS[-1]}.',
                 ['alpha', 'light samples', 'on the metal', 'MIS', 'on the metal'], rows,
                 [lab.command(scene, f'-l 4 -m 5 --alpha {{}}{flags}', 64) for flags in ways.values()])


def _series(counts):
    return ', '.join(map(str, counts))


def importance(lab):
    """Of independent samples, for error times seconds then does not hang on their number; direct light as in the
    write-ups."""
    scene = lab.scene('CBbunny_microfacet_cu', 'cornell_metal')
    base = '-l 1 -m 5 --sampler random'
    ways = {'cosine': '--direct light --bsdf-sampling cosine',
            'half vectors (ndf)': '--direct light --bsdf-sampling ndf',
            'visible half vectors (vndf)': '--direct light --bsdf-sampling vndf',
            'vndf and MIS (our default)': '--bsdf-sampling vndf',
            'vndf, hemisphere (-H)': '-H --bsdf-sampling vndf'}
    halves = [lab.render(scene, f'-l 1 -m 5 --seed {seed}', 256)[0].astype(float) for seed in (1001, 1002)]
    reference = sum(halves) / 2
    own = float(np.mean((halves[0] - halves[1])**2 / 4 / (reference + picture_error.FLOOR)**2))
    error, seconds = {name: [] for name in ways}, {name: [] for name in ways}
    for seed in range(1, SEEDS + 1):  # in turn, for the machine's speed changes
        for name, flags in ways.items():
            picture, record = lab.render(scene, f'{base} {flags} --seed {seed}', 16)
            error[name].append(picture_error.mrse(picture, reference) - own)
            seconds[name].append(record['seconds'])
    mean = {name: float(np.mean(found)) for name, found in error.items()}
    least = {name: min(found) for name, found in seconds.items()}
    worth = {name: mean[name] * least[name] for name in ways}
    cosine, ndf, vndf, mis, hemisphere = ways
    quieter = all(n < c for n, c in zip(error[ndf], error[cosine]))
    ratio = least[ndf] / least[cosine]
    verdict = FAILS if not quieter else HOLDS if ratio < 1.1 else f'{CONDITION}: at {ratio:.2f} times the time'
    rows = [[name, f'{mean[name]:.3g}', f'{least[name]:.3g} s', f'{worth[name]:.3g}',
             f'{worth[cosine] / worth[name]:.2f} ×'] for name in ways]
    return Claim('Importance sampling decreases noise without affecting the time', verdict,
                 f'Sampling half vectors has {mean[cosine] / mean[ndf]:.2f} times less MRSE than cosine-weighted '
                 'directions, in '
                 f'{ratio:.2f} of the time; visible half vectors {mean[cosine] / mean[vndf]:.2f} times less. Direct '
                 'light by uniform '
                 f'directions (-H) takes {worth[hemisphere] / worth[vndf]:.3g} times the time of light samples to the '
                 'same error; '
                 f'MIS takes {worth[mis] / worth[vndf]:.2f} of it.',
                 f'It decreases noise if each of {SEEDS} seeds has less error; the time is unaffected if it is within '
                 '10%. MRSE '
                 'against 512 samples, whose own error is taken off; the least seconds of the seeds.',
                 ['sampling', 'MRSE', 'seconds', 'MRSE x seconds', 'sooner than cosine'], rows,
                 [lab.command(scene, f'{base} {flags} --seed {{}}', 16) for flags in ways.values()])
