"""Reads the part of COLLADA that the Cornell box scenes use: triangles and polygons in fans, spheres of the CGL
profile, node transforms, one camera. A reader of its own, so that a mistake in Lanewise's loader shows as a difference
of pictures.

Area lights of <library_lights> are skipped: where a scene has one, an emissive mesh stands in its place.
"""
import dataclasses
import xml.etree.ElementTree as ElementTree

import numpy as np

IDENTITY = np.eye(4)


@dataclasses.dataclass
class Mesh:
    material: dict
    positions: np.ndarray  # (vertices, 3), world
    faces: np.ndarray  # (triangles, 3)


@dataclasses.dataclass
class Sphere:
    material: dict
    center: np.ndarray
    radius: float


@dataclasses.dataclass
class Camera:
    eye: np.ndarray
    target: np.ndarray
    tan_x: float  # half the picture's width at distance 1
    tan_y: float

    def framed(self, width, height):
        """As wide, with square pixels."""
        return Camera(self.eye, self.target, self.tan_x, self.tan_x * height / width)


class Scene:
    def __init__(self, path):
        self.path = path
        self.root = ElementTree.parse(path).getroot()
        for element in self.root.iter():
            element.tag = element.tag.rsplit('}', 1)[-1]
        self.by_id = {e.get('id'): e for e in self.root.iter() if e.get('id')}
        self.shapes, self.file_camera = [], None
        for node in self.root.find('.//visual_scene').findall('node'):
            self._visit(node, IDENTITY)

    def camera(self, view):
        """'file': the file's camera. 'fit': from 1.5 diagonals away along its axis, framed for 480 x 360 pixels with a
        focal length of 600 / (2 tan_y) pixels, as the course program does and `lanewise render --view fit`."""
        to_world, tan_x, tan_y = self.file_camera
        back = to_world[:3, 2] / np.linalg.norm(to_world[:3, 2])
        if view == 'file':
            eye = to_world[:3, 3]
            return Camera(eye, eye - back, tan_x, tan_y)
        boxes = [(s.positions.min(0), s.positions.max(0)) if isinstance(s, Mesh) else
                 (s.center - s.radius, s.center + s.radius) for s in self.shapes]
        lo, hi = np.min([b[0] for b in boxes], 0), np.max([b[1] for b in boxes], 0)
        center = (lo + hi) / 2
        pixel = 2 * max(tan_y, tan_x * 360 / 480) / 600  # as core/framing.cc: the field of view holds all of the file's
        return Camera(center + 1.5 * np.linalg.norm(hi - lo) * back, center, 240 * pixel, 180 * pixel)

    def _visit(self, node, parent):
        to_world = parent
        for child in node:
            to_world = to_world @ _transform(child)
        for child in node:
            if child.tag == 'node':
                self._visit(child, to_world)
            elif child.tag == 'instance_geometry':
                self._add_geometry(child, to_world)
            elif child.tag == 'instance_camera':
                camera = self._refer(child, 'url')
                tan_x = np.tan(np.radians(float(camera.find('.//xfov').text)) / 2)
                self.file_camera = to_world, tan_x, tan_x / float(camera.find('.//aspect_ratio').text)

    def _refer(self, element, attribute):
        return self.by_id[element.get(attribute)[1:]]

    def _add_geometry(self, instance, to_world):
        geometry = self._refer(instance, 'url')
        bound = {m.get('symbol'): self._material(self._refer(m, 'target')) for m in instance.iter('instance_material')}
        radius = geometry.find('.//sphere/radius')
        if radius is not None:
            scale = np.cbrt(np.linalg.det(to_world[:3, :3]))
            self.shapes.append(Sphere(next(iter(bound.values())), to_world[:3, 3], abs(scale) * float(radius.text)))
            return
        for part in [*geometry.iter('polylist'), *geometry.iter('triangles')]:
            positions, faces = self._read_part(part)
            if np.linalg.det(to_world[:3, :3]) < 0:
                faces = faces[:, [0, 2, 1]]
            positions = positions @ to_world[:3, :3].T + to_world[:3, 3]
            self.shapes.append(Mesh(bound[part.get('material')], positions, faces))

    def _read_part(self, part):
        inputs = {i.get('semantic'): i for i in part.findall('input')}
        stride = 1 + max(int(i.get('offset')) for i in part.findall('input'))
        source = self._refer(self._refer(inputs['VERTEX'], 'source').find("input[@semantic='POSITION']"), 'source')
        positions = _numbers(source.find('float_array')).reshape(-1, 3)
        corners = np.array(part.find('p').text.split(), int).reshape(-1, stride)[:, int(inputs['VERTEX'].get('offset'))]
        counts = part.find('vcount')
        counts = np.full(len(corners) // 3, 3) if counts is None else np.array(counts.text.split(), int)
        if (counts == 3).all():
            return positions, corners.reshape(-1, 3)
        first = np.concatenate([[0], np.cumsum(counts)[:-1]])
        return positions, np.array([[corners[f], corners[f + k], corners[f + k + 1]]
                                    for f, n in zip(first, counts) for k in range(1, n - 1)])

    def _material(self, material):
        effect = self._refer(material.find('instance_effect'), 'url')
        technique = effect.find("extra/technique[@profile='CGL']")
        if technique is not None and len(technique):
            return {'kind': technique[0].tag, **{e.tag: _numbers(e).tolist() for e in technique[0]}}
        color = effect.find('.//diffuse/color')
        return {'kind': 'diffuse', 'reflectance': [0.0] * 3 if color is None else _numbers(color)[:3].tolist()}


def smooth_normals(mesh):
    """Unit normals at the vertices, means of the faces' weighted by area."""
    p, f = mesh.positions, mesh.faces
    area = np.cross(p[f[:, 1]] - p[f[:, 0]], p[f[:, 2]] - p[f[:, 0]])
    sums = np.zeros_like(p)
    for corner in range(3):
        np.add.at(sums, f[:, corner], area)
    return sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-300)


def has_smooth_faces(scene):
    """Whether smooth normals differ from the faces' own anywhere."""
    for mesh in (s for s in scene.shapes if isinstance(s, Mesh)):
        p, f = mesh.positions, mesh.faces
        face = np.cross(p[f[:, 1]] - p[f[:, 0]], p[f[:, 2]] - p[f[:, 0]])
        face /= np.maximum(np.linalg.norm(face, axis=1, keepdims=True), 1e-300)
        if np.abs(smooth_normals(mesh)[f] - face[:, None]).max() > 1e-6:
            return True
    return False


def _numbers(element):
    return np.array(element.text.split(), float)


def _transform(element):
    if element.tag == 'matrix':
        return _numbers(element).reshape(4, 4)
    m = np.eye(4)
    if element.tag == 'translate':
        m[:3, 3] = _numbers(element)
    elif element.tag == 'scale':
        m[:3, :3] = np.diag(_numbers(element))
    elif element.tag == 'rotate':
        *axis, degrees = _numbers(element)
        x, y, z = axis / np.linalg.norm(axis)
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        m[:3, :3] = c * np.eye(3) + s * cross + (1 - c) * np.outer([x, y, z], [x, y, z])
    return m
