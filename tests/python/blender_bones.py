"""What Blender makes of a .glb, as JSON: how many vertices its largest mesh has, and where bones begin (Blender's
axes, z up). A process of its own, because Blender and ossa bring libraries of one name.

usage: blender_bones.py FILE TIMES BONES      both lists as JSON; times in seconds from the beginning
"""
import json
import os
import sys

import bpy

path, times, bones = sys.argv[1], json.loads(sys.argv[2]), json.loads(sys.argv[3])
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=path)
armature = next(o for o in bpy.data.objects if o.type == "ARMATURE")
scene = bpy.context.scene
places = []
for time_s in times:
    at = time_s * scene.render.fps / scene.render.fps_base
    scene.frame_set(int(at), subframe=at % 1)
    places.append({bone: list(armature.matrix_world @ armature.pose.bones[bone].head) for bone in bones})
vertices = max(len(o.data.vertices) for o in bpy.data.objects if o.type == "MESH")
print("\n" + json.dumps({"vertices": vertices, "places": places}), flush=True)  # after what the importer says
os._exit(0)  # Blender as a module may crash while the interpreter ends
