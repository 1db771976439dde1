"""A peer renderer kept at work by peer.py: `peer_worker.py NAME`, in the virtual environment of that renderer. NAME is
"mitsuba VARIANT [SAMPLER]" (independent), "cycles", or "luxcore [hybrid]" (caustics from the lights).

Reads requests, a JSON object a line, and answers each with one: {"scene", "view", "width", "height", "threads"} loads,
{"depth", "samples", "seed", "picture"} renders, writes the picture as .npy and answers {"seconds"} of rendering alone.
What the renderer prints goes to stderr.
"""
import functools
import json
import os
import pathlib
import sys
import time

import numpy as np

import collada


def open_mitsuba(variant, sampler='independent'):
    import render_mitsuba

    def open_scene(scene, camera, width, height, threads):
        loaded = render_mitsuba.MitsubaScene(scene, camera, 'flat', width, height, threads, variant, sampler)

        def render(*what):
            start = time.perf_counter()
            picture = loaded.render(*what)
            return time.perf_counter() - start, picture
        return render
    return open_scene, f'{render_mitsuba.mitsuba_version()} {variant}, {sampler} sampler'


def open_cycles():
    import render_cycles
    return clocked(render_cycles.CyclesScene), render_cycles.VERSION


def open_luxcore(*modes):
    import render_luxcore
    return clocked(functools.partial(render_luxcore.LuxcoreScene, hybrid='hybrid' in modes)), render_luxcore.VERSION


def clocked(scene_class):
    """For scenes that clock their own renders."""
    def open_scene(*what):
        loaded = scene_class(*what)

        def render(*what):
            picture = loaded.render(*what)
            return loaded.seconds, picture
        return render
    return open_scene


def main():
    answers = os.fdopen(os.dup(1), 'w')
    os.dup2(2, 1)
    program, *modes = sys.argv[1].split()
    open_scene, version = {'mitsuba': open_mitsuba, 'cycles': open_cycles, 'luxcore': open_luxcore}[program](*modes)

    def answer(**values):
        answers.write(json.dumps(values) + '\n')
        answers.flush()

    answer(version=version)
    render = None
    for line in sys.stdin:
        request = json.loads(line)
        if 'scene' in request:
            scene = collada.Scene(pathlib.Path(request['scene']))
            size = request['width'], request['height']
            render = open_scene(scene, scene.camera(request['view']).framed(*size), *size, request['threads'])
            answer()
        else:
            seconds, picture = render(request['depth'], request['samples'], request['seed'])
            np.save(request['picture'], picture)
            answer(seconds=seconds)


if __name__ == '__main__':
    main()
