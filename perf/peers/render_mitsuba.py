"""Mitsuba 3 under the transport of `lanewise render`, on what `lanewise convert` makes of a scene.

Lanewise's -m D counts scattering events: Mitsuba's max_depth is D + 1. The tests of pictures compare the shapes that Mitsuba
has loaded with those of a reader of their own (check_shapes).
"""
import pathlib
import sys
import tempfile

import numpy as np

import collada

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
import lanewise  # noqa: E402

VARIANT = 'scalar_rgb'
SAMPLER = 'multijitter'  # with 64 samples a third to a thirtieth of independent samples' variance
ROULETTE_DEPTH = 5  # as in Lanewise; only where paths get that long, for it adds noise and saves nothing on short ones
SEED_STRIDE = 4  # a render takes random streams for whole 32 x 32 blocks, up to 4 times its pixels: none are shared


def mitsuba_version():
    """None where Mitsuba is not installed."""
    try:
        import mitsuba
    except ImportError:
        return None
    return mitsuba.__version__


class MitsubaScene:
    """The file of a collada.Scene, loaded once for renders of many depths and seeds."""

    def __init__(self, scene, camera, normals, width, height, threads, variant=VARIANT, sampler=SAMPLER,
                 flags=()):
        """flags: of `lanewise convert`, besides."""
        import drjit
        import mitsuba
        mitsuba.set_variant(variant)
        drjit.set_thread_count(threads)
        self.mi = mitsuba
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / 'scene.xml'
            lanewise.convert(scene.path, file, '-r', width, height, '--normals', normals, *flags, camera=camera)
            self.scene = mitsuba.load_file(str(file), sampler=sampler)

    def render(self, depth, samples, seed):
        """Means per pixel, (height, width, 3), row 0 at the top."""
        long = depth >= ROULETTE_DEPTH + 1
        integrator = self.mi.load_dict({'type': 'path', 'max_depth': depth + 1,
                                        'rr_depth': ROULETTE_DEPTH if long else 1 << 20})
        return np.array(self.mi.render(self.scene, integrator=integrator, spp=samples, seed=SEED_STRIDE * seed))

    def check_shapes(self, scene):
        """That Mitsuba's shapes, which it merges where it can, have the bounds and the area of the collada.Scene's."""
        theirs = self.scene.bbox()
        boxes = [_box(shape) for shape in scene.shapes]
        ours = np.array([np.min([box[0] for box in boxes], 0), np.max([box[1] for box in boxes], 0)])
        area = sum(map(_area, scene.shapes))
        found = sum(float(np.ravel(shape.surface_area())[0]) for shape in self.scene.shapes())
        if not np.allclose(ours, [theirs.min, theirs.max], atol=1e-4) or abs(found - area) > 1e-4 * area:
            raise SystemExit(f'{scene.path}: what Lanewise converts has other shapes than what collada.py reads')


def _box(shape):
    if isinstance(shape, collada.Sphere):
        return shape.center - shape.radius, shape.center + shape.radius
    used = shape.positions[shape.faces.ravel()]
    return used.min(0), used.max(0)


def _area(shape):
    if isinstance(shape, collada.Sphere):
        return 4 * np.pi * shape.radius**2
    a, b, c = (shape.positions[shape.faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
