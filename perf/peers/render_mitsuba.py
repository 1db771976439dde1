"""Mitsuba 3 under the transport of `lanewise render`.

Lanewise's -m D counts scattering events: Mitsuba's max_depth is D + 1. Emitters shine from the side that the winding
faces, the filter is a box, opaque materials are two-sided. Smooth normals are set here, by area over shared vertices:
Mitsuba's own weigh by angle.
"""
import numpy as np

import collada

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
    """A collada.Scene, loaded once for renders of many depths and seeds."""

    def __init__(self, scene, camera, normals, width, height, threads, variant=VARIANT, sampler=SAMPLER):
        import drjit
        import mitsuba
        mitsuba.set_variant(variant)
        drjit.set_thread_count(threads)
        self.mi, self.sampler = mitsuba, sampler
        self.camera, self.width, self.height = camera, width, height
        self.scene = mitsuba.load_dict({'type': 'scene', **{
            f'shape{i}': self._shape(s, normals == 'smooth') for i, s in enumerate(scene.shapes)}})

    def render(self, depth, samples, seed):
        """Means per pixel, (height, width, 3), row 0 at the top."""
        long = depth >= ROULETTE_DEPTH + 1
        integrator = self.mi.load_dict({'type': 'path', 'max_depth': depth + 1,
                                        'rr_depth': ROULETTE_DEPTH if long else 1 << 20})
        return np.array(self.mi.render(self.scene, sensor=self._sensor(samples), integrator=integrator, spp=samples,
                                       seed=SEED_STRIDE * seed))

    def _sensor(self, samples):
        camera = self.camera
        to_world = self.mi.ScalarTransform4f().look_at(origin=camera.eye.tolist(), target=camera.target.tolist(),
                                                       up=[0, 0, 1])
        return self.mi.load_dict({
            'type': 'perspective', 'fov': float(2 * np.degrees(np.arctan(camera.tan_y))), 'fov_axis': 'y',
            'near_clip': 1e-3, 'far_clip': 1e4, 'to_world': to_world,
            'sampler': {'type': self.sampler, 'sample_count': samples},
            'film': {'type': 'hdrfilm', 'width': self.width, 'height': self.height, 'rfilter': {'type': 'box'},
                     'component_format': 'float32', 'pixel_format': 'rgb'}})

    def _shape(self, shape, smooth):
        bsdf = _bsdf(shape.material)
        if isinstance(shape, collada.Sphere):
            return {'type': 'sphere', 'center': shape.center.tolist(), 'radius': shape.radius, 'bsdf': bsdf}
        properties = self.mi.Properties()
        properties['bsdf'] = self.mi.load_dict(bsdf)
        properties['face_normals'] = not smooth
        if shape.material['kind'] == 'emission':
            properties['emitter'] = self.mi.load_dict({'type': 'area', 'radiance': _rgb(shape.material['radiance'])})
        mesh = self.mi.Mesh('', len(shape.positions), len(shape.faces), has_vertex_normals=smooth, props=properties)
        parameters = self.mi.traverse(mesh)
        parameters['vertex_positions'] = shape.positions.astype(np.float32).ravel()
        parameters['faces'] = shape.faces.astype(np.uint32).ravel()
        if smooth:
            parameters['vertex_normals'] = collada.smooth_normals(shape).astype(np.float32).ravel()
        parameters.update()
        return mesh


def _rgb(value):
    return {'type': 'rgb', 'value': value}


def _bsdf(material):
    kind = material['kind']
    if kind == 'emission':
        return {'type': 'diffuse', 'reflectance': _rgb([0.0, 0.0, 0.0])}
    if kind in ('glass', 'refraction'):
        return {'type': 'dielectric', 'int_ior': material['ior'][0], 'ext_ior': 1.0,
                'specular_reflectance': _rgb(material['reflectance']),
                'specular_transmittance': _rgb(material['transmittance'])}
    if kind == 'mirror':
        one_sided = {'type': 'conductor', 'material': 'none', 'specular_reflectance': _rgb(material['reflectance'])}
    elif kind == 'microfacet':
        one_sided = {'type': 'roughconductor', 'distribution': 'beckmann', 'alpha': material['alpha'][0],
                     'eta': _rgb(material['eta']), 'k': _rgb(material['k'])}
    else:
        one_sided = {'type': 'diffuse', 'reflectance': _rgb(material['reflectance'])}
    return {'type': 'twosided', 'bsdf': one_sided}
