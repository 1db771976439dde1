"""LuxCore under the transport of `lanewise render`.

Lanewise's -m D counts scattering events: LuxCore's path depth is D + 1, and D at least 1, for it always samples one
light. Linear radiance from the film's RGB, a filter of one pixel, no denoising, clamping, roulette or adaptive
sampling. hybrid: caustics by tracing from the lights, which lets those have D + 1 events.
Spheres are meshes of 256 x 128 with smooth normals. Its rough metals are only like the scene's: GGX where the scene has
Beckmann, at ROUGHNESS times the alpha, and with the nearest that its conductor formula comes to the exact reflectance;
means are up to 2.4% off (dragon), so its error has a floor there.
"""
import time

import numpy as np
import pyluxcore

import collada

pyluxcore.Init(lambda message: None)
VERSION = pyluxcore.Version()
ROUGHNESS = 0.7  # uroughness / alpha: at 1 the peaks of D are the same, at 0.83 the median slopes


class LuxcoreScene:
    """A collada.Scene, loaded once for renders of many sample counts and seeds."""

    def __init__(self, scene, camera, width, height, threads, hybrid=False):
        self.width, self.height, self.threads, self.hybrid, self.seconds = width, height, threads, hybrid, 0
        self.scene = pyluxcore.Scene()
        shift = -2 / height  # its camera is a row of pixels off
        self.scene.Parse(_properties({
            'scene.camera.type': 'perspective', 'scene.camera.lookat.orig': _floats(camera.eye),
            'scene.camera.lookat.target': _floats(camera.target), 'scene.camera.up': [0.0, 0.0, 1.0],
            'scene.camera.fieldofview': float(2 * np.degrees(np.arctan(camera.tan_y))),
            'scene.camera.screenwindow': [-width / height, width / height, -1 + shift, 1 + shift]}))
        for i, shape in enumerate(scene.shapes):
            self._add_shape(str(i), shape)

    def render(self, depth, samples, seed):
        """Means per pixel, (height, width, 3), row 0 at the top; self.seconds is what it took."""
        deepest = {f'path.pathdepth.{kind}': depth + 1 for kind in ('total', 'diffuse', 'glossy', 'specular')}
        config = pyluxcore.RenderConfig(_properties({
            'renderengine.type': 'PATHCPU', 'renderengine.seed': seed + 1, 'native.threads.count': self.threads,
            'film.width': self.width, 'film.height': self.height, 'film.filter.type': 'NONE',
            'film.opencl.enable': False, 'film.imagepipelines.0.0.type': 'NOP', 'sampler.type': 'SOBOL',
            'sampler.sobol.adaptive.strength': 0.0, 'lightstrategy.type': 'UNIFORM', 'batch.haltspp': [samples, 0], 'path.russianroulette.depth': 1 << 20,
            'path.clamping.variance.maxvalue': 0.0, 'path.hybridbackforward.enable': self.hybrid,
            **deepest}), self.scene)
        session = pyluxcore.RenderSession(config)
        session.Start()  # builds the tree
        start = time.perf_counter()
        while not session.HasDone():
            time.sleep(0.005)
            session.UpdateStats()  # where it looks whether it is done
        self.seconds = time.perf_counter() - start
        session.Stop()
        pixels = np.zeros(self.width * self.height * 3, np.float32)
        session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels, 0, False)
        return pixels.reshape(self.height, self.width, 3)[::-1].copy()

    def _add_shape(self, name, shape):
        if isinstance(shape, collada.Sphere):
            positions, faces, normals = _sphere(shape.center, shape.radius)
        else:
            positions, faces, normals = shape.positions, shape.faces, None
        self.scene.Parse(_properties(_material(name, shape.material)))
        self.scene.DefineMesh(f'mesh{name}', _tuples(positions, float), _tuples(faces, int),
                              None if normals is None else _tuples(normals, float), None, None, None, None)
        self.scene.Parse(_properties({f'scene.objects.{name}.shape': f'mesh{name}',
                                      f'scene.objects.{name}.material': f'material{name}'}))


def _material(name, material):
    """Its properties, and those of its textures."""
    kind, textures = material['kind'], {}
    if kind in ('glass', 'refraction'):
        found = {'type': 'glass', 'kr': _floats(material['reflectance']), 'kt': _floats(material['transmittance']),
                 'exteriorior': 1.0, 'interiorior': material['ior'][0]}
    elif kind == 'mirror':
        found = {'type': 'mirror', 'kr': _floats(material['reflectance'])}
    elif kind == 'microfacet':
        pairs = [_fit_conductor(*pair) for pair in zip(material['eta'], material['k'])]
        fresnel = f'scene.textures.fresnel{name}.'
        textures = {fresnel + 'type': 'fresnelconst', fresnel + 'n': [p[0] for p in pairs],
                    fresnel + 'k': [p[1] for p in pairs]}
        roughness = ROUGHNESS * material['alpha'][0]
        found = {'type': 'metal2', 'fresnel': f'fresnel{name}', 'uroughness': roughness, 'vroughness': roughness}
    elif kind == 'emission':  # radiance, from the front alone, where power and efficiency are 0
        found = {'type': 'matte', 'kd': [0.0] * 3, 'emission': _floats(material['radiance']),
                 'emission.gain': [1.0] * 3, 'emission.power': 0.0, 'emission.efficiency': 0.0,
                 'emission.gain.normalizebycolor': False,
                 'emission.directlightsampling.type': 'ENABLED'}
    else:
        found = {'type': 'matte', 'kd': _floats(material['reflectance'])}
    return {**textures, **{f'scene.materials.material{name}.{key}': value for key, value in found.items()}}


def _reflectance(n, k, cosine):
    """As LuxCore has it, FresnelTexture::GeneralEvaluate."""
    sine2 = (1 - cosine**2) / n**2
    a, b = 1 - sine2, 2 * k**2 * sine2
    t = np.sqrt((a + np.sqrt(a**2 + b**2)) / 2)
    u, v, w = (n**2 + k**2) * cosine**2 + t**2, (n**2 + k**2) * t**2 + cosine**2, 2 * n * cosine * t
    return np.clip(((u - w) / (u + w) + (v - w) / (v + w)) / 2, 0, 1)


def _fit_conductor(n, k):
    """The (n, k) with which LuxCore's formula is nearest to the exact reflectance, by cosine-weighted squares."""
    cosine = (np.arange(64) + 0.5) / 64
    index = n + 1j * k
    t = np.sqrt(1 - (1 - cosine**2) / index**2)
    across, along = (cosine - index * t) / (cosine + index * t), (index * cosine - t) / (index * cosine + t)
    exact = (abs(across)**2 + abs(along)**2) / 2
    log_n, log_k, reach = 0.0, 0.7, 5.0
    for _ in range(24):  # a grid that closes in on its best cell
        steps = reach * np.linspace(-1, 1, 41)
        ns, ks = np.meshgrid(np.exp(log_n + steps), np.exp(log_k + steps))
        error = (cosine * (_reflectance(ns[..., None], ks[..., None], cosine) - exact)**2).sum(-1)
        best = np.unravel_index(error.argmin(), error.shape)
        log_n, log_k, reach = np.log(ns[best]), np.log(ks[best]), 0.6 * reach
    return float(np.exp(log_n)), float(np.exp(log_k))


def _sphere(center, radius, around=256, down=128):
    """Positions, faces and normals: rows of vertices between two poles."""
    u, v = np.meshgrid(2 * np.pi * np.arange(around) / around, np.pi * np.arange(1, down) / down)
    rows = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)], -1).reshape(-1, 3)
    normals = np.vstack([rows, [0, 0, 1], [0, 0, -1]])
    here, last = np.arange(around), (down - 2) * around
    right = (here + 1) % around
    top, bottom = np.full(around, len(rows)), np.full(around, len(rows) + 1)
    faces = [np.stack([top, here, right], -1), np.stack([bottom, last + right, last + here], -1)]
    for first in range(0, last, around):
        below = first + around
        faces += [np.stack([first + here, below + here, below + right], -1),
                  np.stack([first + here, below + right, first + right], -1)]
    return center + radius * normals, np.vstack(faces), normals


def _properties(values):
    result = pyluxcore.Properties()
    for key, value in values.items():
        result.Set(pyluxcore.Property(key, value))
    return result


def _floats(values):
    return [float(x) for x in values]


def _tuples(rows, kind):
    return [tuple(map(kind, row)) for row in rows]
