"""What the charts of `lanewise chart` show, against what is known: run by chart_command_test.cc, with the folder perf/
as its argument. Says nothing where all is as it should be."""
import pathlib
import sys
import tempfile

sys.path[:0] = [sys.argv[1], sys.argv[1] + '/peers']
import numpy as np  # noqa: E402

import chart_summary  # noqa: E402
import collada  # noqa: E402
import lanewise  # noqa: E402
import picture_error  # noqa: E402


def curve(name, samples, seconds_each, error_of_one, noise=0.0, is_peer=False):
    """Error falls with 1 / samples; seeds, in opposite pairs, are `noise` of it off."""
    n = np.array(samples, float)
    seconds = seconds_each * n[:, None] * np.ones(4)
    error = error_of_one / n[:, None] * (1 + noise * np.array([-1, 1, -1, 1]))
    return chart_summary.Curve(name, is_peer, n, seconds, error)


def near(a, b, tolerance=1e-9):
    assert abs(a - b) <= tolerance * abs(b), (a, b)


def check_summary():
    ours, theirs = curve('ours', [1, 2, 4, 8, 16], 0.01, 1.0), curve('theirs', [4, 16], 0.5, 2.0, is_peer=True)
    near(chart_summary.slope(ours, 0).value, -1)
    near(chart_summary.error_after(ours, 0.05).value, 1 / 5)
    assert chart_summary.error_after(ours, 1).bound == '≈'  # past its last point
    near(chart_summary.samples_in(ours, 0.03), 3)
    near(chart_summary.samples_for(ours, 1 / 3), 3)
    ratio, needed = chart_summary.times_sooner(ours, theirs)  # at 2 / 16, which takes ours 8 samples
    near(needed.value, 0.08)
    near(ratio.value, 8 / 0.08)
    assert ratio.bound == needed.bound == '' and ratio.error < 1e-9
    late = curve('late', [1, 2], 1e-9, 9.0)
    assert chart_summary.duel([late, ours, theirs]) == (ours, theirs)
    assert chart_summary.duel([ours]) is None


def check_bounds():
    theirs = curve('theirs', [4, 16], 0.5, 2.0, is_peer=True)
    ratio, needed = chart_summary.times_sooner(curve('better at once', [1, 2], 0.01, 0.1), theirs)
    assert (ratio.bound, needed.bound) == ('>', '<')
    near(needed.value, 0.01)
    ratio, needed = chart_summary.times_sooner(curve('not yet', [1, 2], 0.01, 9.0), theirs)
    assert (ratio.bound, needed.bound) == ('<', '>')
    near(needed.value, 0.02)


def check_errors():
    """The jackknife's error of a mean is that of the mean."""
    values = np.array([1.0, 2.0, 4.0, 9.0])
    found = chart_summary.jackknife(lambda i: values[i].mean(), np.arange(4))
    near(found.value, 4)
    near(found.error, values.std(ddof=1) / 2)
    noisy = curve('noisy', [1, 2, 4, 8, 16], 0.01, 1.0, noise=0.1)
    theirs = curve('theirs', [4, 16], 0.5, 2.0, is_peer=True)
    near(chart_summary.times_sooner(noisy, theirs)[0].error / 100, 0.1 / 3**0.5, 0.05)


def check_pareto():
    fast, slow = curve('fast', [1, 2], 0.01, 1.0), curve('slow', [1, 2, 8], 1.0, 1.0)
    front = chart_summary.pareto_front([fast, slow])
    assert front == [(0.01, 1.0), (0.02, 0.5), (8.0, 0.125)], front


def check_picture_error():
    """The twin of core/image_compare.cc."""
    random = np.random.default_rng(1)
    reference = random.gamma(0.5, size=(9, 7, 3)).astype(np.float32)
    picture = (reference * random.uniform(0.5, 1.5, reference.shape)).astype(np.float32)
    near(picture_error.mrse(picture, reference), picture_error.compare(picture, reference)['mrse'])


def check_views():
    """The peers' cameras are those of `lanewise render --view`, for files of any shape of picture."""
    text = lanewise.SHIPPED[0].read_text()
    assert '<aspect_ratio>1.3333333333333333<' in text
    for aspect in ('1.3333333333333333', '1.7777777777777777', '1'):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / 'scene.dae'
            scene.write_text(text.replace('<aspect_ratio>1.3333333333333333<', f'<aspect_ratio>{aspect}<'))
            flags = '-r', 480, 360, '-m', 1, '-s', 1, '--sampler', 'random'
            by_flag = lanewise.render(scene, *flags, '--view', 'fit')[0]
            camera = collada.Scene(scene).camera('fit').framed(480, 360)
            by_camera = lanewise.render(scene, *flags, camera=camera)[0]
            moved = (np.abs(by_flag - by_camera) > 0.01 * by_flag).any(axis=2).mean()
            assert moved < 0.01, (aspect, moved)


for check in (check_summary, check_bounds, check_errors, check_pareto, check_picture_error, check_views):
    check()
