"""Cycles, as Blender's Python module, under the transport of `lanewise render`.

Lanewise's -m D counts scattering events: Cycles' max_bounces is D - 1, for it counts from the second (so D is at least 1).
No denoising, clamping, blurring or adaptive sampling; the filter is a box; emitters shine from the side that the winding
faces. Cycles has no spheres: they are meshes of 256 x 128 with smooth normals. Its caustics through glass are on.
"""
import pathlib
import tempfile
import time

import bpy
import mathutils
import numpy as np

import collada

VERSION = bpy.app.version_string


class CyclesScene:
    """A collada.Scene; Cycles keeps what it made of it from render to render."""

    def __init__(self, scene, camera, width, height, threads):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.scene, self.seconds = bpy.context.scene, 0
        for i, shape in enumerate(scene.shapes):
            self._add_shape(f'shape{i}', shape)
        self._set_camera(camera, width, height)
        world = bpy.data.worlds.new('black')
        world.use_nodes = True
        world.node_tree.nodes['Background'].inputs[1].default_value = 0
        self.scene.world = world
        render = self.scene.render
        render.engine, render.use_persistent_data = 'CYCLES', True
        render.threads_mode, render.threads = 'FIXED', threads
        render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
        file = render.image_settings
        file.file_format, file.color_depth, file.exr_codec = 'OPEN_EXR', '32', 'NONE'
        cycles = self.scene.cycles
        cycles.device, cycles.use_adaptive_sampling, cycles.use_denoising, cycles.use_guiding = 'CPU', False, False, False
        cycles.caustics_reflective = cycles.caustics_refractive = True
        cycles.blur_glossy = cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
        cycles.pixel_filter_type = 'BOX'
        bpy.app.handlers.render_post.append(self._stop)

    def render(self, depth, samples, seed):
        """Means per pixel, (height, width, 3), row 0 at the top; self.seconds is what it took without the file."""
        cycles = self.scene.cycles
        cycles.samples, cycles.seed = samples, seed
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = depth - 1
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / 'picture.exr'
            self.scene.render.filepath = str(path)
            self._start = time.perf_counter()
            bpy.ops.render.render(write_still=True)
            image = bpy.data.images.load(str(path))
            pixels = np.empty(len(image.pixels), np.float32)
            image.pixels.foreach_get(pixels)
            width, height = image.size
            bpy.data.images.remove(image)
        return pixels.reshape(height, width, -1)[::-1, :, :3].copy()

    def _stop(self, *_):
        self.seconds = time.perf_counter() - self._start

    def _set_camera(self, camera, width, height):
        data = bpy.data.cameras.new('camera')
        data.sensor_fit = 'VERTICAL' if height <= width else 'HORIZONTAL'
        data.angle = 2 * np.arctan(camera.tan_y if height <= width else camera.tan_x)
        item = bpy.data.objects.new('camera', data)
        item.location = camera.eye
        item.rotation_euler = mathutils.Vector(camera.target - camera.eye).to_track_quat('-Z', 'Y').to_euler()
        self.scene.collection.objects.link(item)
        self.scene.camera = item

    def _add_shape(self, name, shape):
        if isinstance(shape, collada.Sphere):
            bpy.ops.mesh.primitive_uv_sphere_add(segments=256, ring_count=128, radius=shape.radius, location=shape.center)
            bpy.ops.object.shade_smooth()
            item = bpy.context.object
        else:
            mesh = bpy.data.meshes.new(name)
            mesh.from_pydata(shape.positions.tolist(), [], shape.faces.tolist())
            item = bpy.data.objects.new(name, mesh)
            self.scene.collection.objects.link(item)
        item.data.materials.append(_material(name, shape.material))


def _material(name, material):
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    tree = result.node_tree
    tree.nodes.clear()
    surface = _surface(tree, result, material)
    tree.links.new(surface.outputs[0], tree.nodes.new('ShaderNodeOutputMaterial').inputs[0])
    return result


def _surface(tree, owner, material):
    kind = material['kind']
    if kind == 'emission':
        return _one_sided_emission(tree, owner, material['radiance'])
    if kind == 'mirror':
        node = tree.nodes.new('ShaderNodeBsdfAnisotropic')
        node.inputs['Roughness'].default_value = 0
        node.inputs['Color'].default_value = (*material['reflectance'], 1)
    elif kind in ('glass', 'refraction'):
        node = tree.nodes.new('ShaderNodeBsdfGlass')
        node.inputs['Roughness'].default_value = 0
        node.inputs['Color'].default_value = (*material['transmittance'], 1)
        node.inputs['IOR'].default_value = material['ior'][0]
    elif kind == 'microfacet':
        node = tree.nodes.new('ShaderNodeBsdfMetallic')
        node.fresnel_type, node.distribution = 'PHYSICAL_CONDUCTOR', 'BECKMANN'
        node.inputs['IOR'].default_value, node.inputs['Extinction'].default_value = material['eta'], material['k']
        node.inputs['Roughness'].default_value = material['alpha'][0] ** 0.5
    else:
        node = tree.nodes.new('ShaderNodeBsdfDiffuse')
        node.inputs['Color'].default_value = (*material['reflectance'], 1)
    return node


def _one_sided_emission(tree, owner, radiance):
    light, black = tree.nodes.new('ShaderNodeEmission'), tree.nodes.new('ShaderNodeBsdfDiffuse')
    light.inputs['Color'].default_value = (*(x / max(radiance) for x in radiance), 1)
    light.inputs['Strength'].default_value = max(radiance)
    black.inputs['Color'].default_value = (0, 0, 0, 1)
    either, side = tree.nodes.new('ShaderNodeMixShader'), tree.nodes.new('ShaderNodeNewGeometry')
    for source, target in zip((side.outputs['Backfacing'], light.outputs[0], black.outputs[0]), either.inputs):
        tree.links.new(source, target)
    owner.cycles.emission_sampling = 'FRONT'
    return either
