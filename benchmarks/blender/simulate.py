"""One scene by Blender's cloth, for `compare`, until it is at rest:

    blender --background --factory-startup --python simulate.py -- SCENE.npz OUT.npz

SCENE has `rest`, `start` and `triangles` of the cloth, the vertices that are `pinned`, the `gap` that contact keeps [m], `ball` and
`ball_triangles` (empty without one), and `frames`, how many at most. OUT has of each frame the CPU seconds up to it (`seconds`) and
the net force on the free vertices over their weight (`residuals`), and the last frame's positions (`x`).
"""

import sys
import time

import bpy
import numpy

AT_REST = 1e-3  # drape's tolerance of the force residual
SUBSTEPS = 5  # steps of the solver in a frame: the default


def mesh_object(name, vertices, triangles):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
    created = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(created)
    return created


def cloth_of(scene):
    """The cloth with Blender's preset of cotton, but for the distance of contact."""
    cloth = mesh_object("cloth", scene["start"], scene["triangles"])
    cloth.shape_key_add(name="start")
    cloth.shape_key_add(name="rest").data.foreach_set("co", scene["rest"].ravel())
    cloth.vertex_groups.new(name="pins").add(scene["pinned"].tolist(), 1.0, "REPLACE")
    modifier = cloth.modifiers.new("cloth", "CLOTH")
    settings, contact = modifier.settings, modifier.collision_settings
    settings.quality = SUBSTEPS
    settings.mass = 0.3  # of each vertex: its springs are made for it, and jitter for ever with the mass that drape has
    settings.tension_stiffness = settings.compression_stiffness = 15
    settings.shear_stiffness, settings.bending_stiffness = 15, 0.5
    settings.vertex_group_mass = "pins"
    settings.rest_shape_key = cloth.data.shape_keys.key_blocks["rest"]
    contact.use_collision = contact.use_self_collision = len(scene["ball"]) > 0
    contact.distance_min = contact.self_distance_min = float(scene["gap"])
    contact.friction = contact.self_friction = 0
    modifier.point_cache.frame_end = int(scene["frames"])
    return cloth


def positions(cloth):
    mesh = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    x = numpy.empty(3 * len(mesh.vertices), dtype=numpy.float32)
    mesh.vertices.foreach_get("co", x)
    return x.reshape(-1, 3).astype(float)


def main(scene_file, out):
    scene = numpy.load(scene_file)
    for old in list(bpy.data.objects):
        bpy.data.objects.remove(old)
    if len(scene["ball"]):
        ball = mesh_object("ball", scene["ball"], scene["ball_triangles"])
        ball.modifiers.new("collision", "COLLISION")
        ball.collision.thickness_outer = float(scene["gap"])
        ball.collision.cloth_friction = 0
    cloth = cloth_of(scene)
    view = bpy.context.scene
    view.render.fps = 24
    view.frame_end = int(scene["frames"])
    free = numpy.setdiff1d(numpy.arange(len(scene["rest"])), scene["pinned"])
    last, seconds, residuals, spent = [], [], [], 0.0
    for frame in range(1, int(scene["frames"]) + 1):
        begin = time.process_time()
        view.frame_set(frame)
        last = [*last[-2:], positions(cloth)]
        spent += time.process_time() - begin
        seconds.append(spent)
        if len(last) < 3:
            residuals.append(1.0)
            continue
        acceleration = (last[2] - 2 * last[1] + last[0])[free] * view.render.fps**2
        residuals.append(float(numpy.linalg.norm(acceleration) / (9.81 * len(free) ** 0.5)))
        velocity = (last[2] - last[1])[free] * view.render.fps
        speed = numpy.linalg.norm(velocity) / len(free) ** 0.5
        if residuals[-1] < AT_REST and speed < 1e-3:
            break
    numpy.savez(out, seconds=seconds, residuals=residuals, x=last[-1])


main(*sys.argv[sys.argv.index("--") + 1:])
