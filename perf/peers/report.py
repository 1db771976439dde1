"""The pages that unbiased.py writes to perf/results."""
import dataclasses
import json

import numpy as np

import lanewise
import render_mitsuba
import welch

FOLDER = lanewise.RESULTS


def print_and_write(name, text, data=None):
    print(text)
    FOLDER.mkdir(exist_ok=True)
    (FOLDER / f'{name}.md').write_text(text)
    if data is not None:
        (FOLDER / f'{name}.json').write_text(json.dumps(data, indent=1) + '\n')


def comparison_page(rows, command, samples, second='normals', subject='Lanewise beside Mitsuba 3'):
    """rows: (scene, normals, depth, Comparison), or what `second` names in the normals' place. samples: a sentence that
    says how many."""
    passed = {test: sum(c.verdicts[test] for *_, c in rows) for test in rows[0][3].verdicts}
    agree = min(passed.values()) == len(rows)
    ratios = [abs(d) / e for *_, c in rows for d, e in zip(c.difference, c.error) if e > 0]
    largest = max((abs(d), e) for *_, c in rows for d, e in zip(c.difference, c.error))
    lines = [
        f'# {subject}: the same pictures?', '',
        f'Lanewise {lanewise.version()}, Mitsuba {render_mitsuba.mitsuba_version()} {render_mitsuba.VARIANT}; '
        f'{lanewise.processor()}. {samples}', '',
        f'    {command}', '',
        f'**{"All pictures agree." if agree else "Not all pictures pass."}** Of {len(rows)} pictures '
        f'{passed["pixels"]} pass the test of pixels, {passed["shares"]} that of shares, {passed["blocks"]} that of '
        f'blocks; in {passed["means"]} all means differ by less than 0.1%. The largest difference of a mean is '
        f'{100 * largest[0]:.3f}% ± {100 * largest[1]:.3f}%; over all means, the root mean square of difference / '
        f'standard error is {np.sqrt(np.mean(np.square(ratios))):.2f} (1 for equal renderers), the largest '
        f'{max(ratios):.1f}. Averaged over all pictures by precision: {pooled_difference(rows)}.', '',
        'Pixels: share that passes (least of luminance, R, G and B), at least 99.75%. p < 0.05: share of the pixels, '
        'at most 5.8%. Block: least p-value of 10 x 10 pixels, corrected for all blocks of the table, at least 0.01. '
        'Means: Lanewise against Mitsuba in %, ± one standard error. perf/peers/welch.py explains the tests.', '',
        f'| scene | {second} | -m | pixels, % | p < 0.05, % | block | R, % | G, % | B, % | |', '|---' * 10 + '|']
    for scene, normals, depth, c in rows:
        means = ' | '.join(f'{100 * d:+.3f} ± {100 * e:.3f}' for d, e in zip(c.difference, c.error))
        faults = [test for test, good in c.verdicts.items() if not good]
        lines.append(f'| {scene} | {normals} | {depth} | {100 * min(c.pixels):.2f} | {100 * c.low_p:.2f} | '
                     f'{c.worst_block:.2g} | {means} | {", ".join(faults) or "ok"} |')
    data = {'lanewise': lanewise.version(), 'mitsuba': render_mitsuba.mitsuba_version(),
            'processor': lanewise.processor(), 'command': command, 'samples': samples,
            'pictures': [{'scene': scene, second: normals, 'depth': depth, **dataclasses.asdict(c),
                          'verdicts': c.verdicts} for scene, normals, depth, c in rows]}
    return '\n'.join(lines) + '\n', data


def pooled_difference(rows):
    differences, errors = (np.array([getattr(c, name) for *_, c in rows]) for name in ('difference', 'error'))
    weights = 1 / errors**2
    means, error = (weights * differences).sum(0) / weights.sum(0), weights.sum(0) ** -0.5
    return ', '.join(f'{name} {100 * d:+.4f} ± {100 * e:.4f}%' for name, d, e in zip('RGB', means, error))


def validation_page(groups, command):
    """groups: (what is compared, [Comparison]); the tests must accept the first and find the others."""
    lines = ['# What the comparison with Mitsuba 3 accepts and finds', '',
             'How many pictures fail each test of perf/peers/welch.py. The first rows compare a renderer with itself, '
             'half of its seeds with the other half: no test should fail. The last ones plant an error in Lanewise\'s. '
             'Even 0.3% shows in pixels, in those that see the light alone and have no noise; elsewhere blocks find '
             'more.', '',
             f'    {command}', '',
             '| compared | pictures | pixels | shares | blocks | p < 0.05, mean % |', '|---|---|---|---|---|---|']
    for what, comparisons in groups:
        failed = [sum(not c.verdicts[test] for c in comparisons) for test in ('pixels', 'shares', 'blocks')]
        low = np.mean([c.low_p for c in comparisons])
        lines.append(f'| {what} | {len(comparisons)} | {" | ".join(map(str, failed))} | {100 * low:.2f} |')
    return '\n'.join(lines) + '\n'
