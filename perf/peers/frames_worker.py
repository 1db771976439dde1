"""A peer renderer kept at work by frames.py: `frames_worker.py NAME`, in the virtual environment of that renderer.

Reads requests, a JSON object a line, and answers each with one: {"scene", "view", "width", "height", "threads"} loads,
{"depth", "samples", "seed", "picture"} renders, writes the picture as .npy and answers {"seconds"} of rendering alone. What
the renderer prints goes to stderr.
"""
import json
import os
import pathlib
import sys
import time

import numpy as np

import collada


def open_mitsuba(variant):
    import render_mitsuba

    def open_scene(scene, camera, width, height, threads):
        loaded = render_mitsuba.MitsubaScene(scene, camera, 'flat', width, height, threads, variant, 'independent')

        def render(*what):
            start = time.perf_counter()
            picture = loaded.render(*what)
            return time.perf_counter() - start, picture
        return render
    return open_scene, f'{render_mitsuba.mitsuba_version()} {variant}'


def open_cycles():
    import render_cycles

    def open_scene(*what):
        loaded = render_cycles.CyclesScene(*what)

        def render(*what):
            picture = loaded.render(*what)
            return loaded.seconds, picture
        return render
    return open_scene, render_cycles.VERSION


def main():
    answers = os.fdopen(os.dup(1), 'w')
    os.dup2(2, 1)
    name = sys.argv[1]
    open_scene, version = open_cycles() if name == 'cycles' else open_mitsuba(name.removeprefix('mitsuba '))

    def answer(**values):
        answers.write(json.dumps(values) + '\n')
        answers.flush()

    answer(version=version)
    render = None
    for line in sys.stdin:
        request = json.loads(line)
        if 'scene' in request:
            scene = collada.Scene(pathlib.Path(request['scene']))
            render = open_scene(scene, scene.camera(request['view']), request['width'], request['height'],
                                request['threads'])
            answer()
        else:
            seconds, picture = render(request['depth'], request['samples'], request['seed'])
            np.save(request['picture'], picture)
            answer(seconds=seconds)


if __name__ == '__main__':
    main()
