"""Runs inside Blender: imports a glTF file into an empty scene, and writes what there is then as JSON.

    blender --background --python import.py -- FILE.glb OUT.json"""

import json
import sys

import bpy


def corners(points):
    """Lower and upper corner of points."""
    axes = list(zip(*points))
    return [min(axis) for axis in axes], [max(axis) for axis in axes]


def described(thing):
    mesh = thing.data
    lower, upper = corners([thing.matrix_world @ vertex.co for vertex in mesh.vertices])
    found = {"vertices": len(mesh.vertices), "lower": lower, "upper": upper}
    if mesh.uv_layers:
        found["uv_lower"], found["uv_upper"] = corners([loop.uv for loop in mesh.uv_layers[0].data])
    keys = mesh.shape_keys
    found["shape_keys"] = len(keys.key_blocks) - 1 if keys else 0
    found["animated"] = bool(keys and keys.animation_data)
    return found


file, out = sys.argv[sys.argv.index("--") + 1:]
for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
# The default, shading by normals, fails in Debian 12: its Blender 3.4 needs an older numpy than its own.
bpy.ops.import_scene.gltf(filepath=file, import_shading="SMOOTH")
with open(out, "w") as stream:
    json.dump({thing.name: described(thing) for thing in bpy.data.objects if thing.type == "MESH"}, stream)
