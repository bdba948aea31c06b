# SPDX-License-Identifier: Apache-2.0
# blender -b --factory-startup -noaudio --python read.py -- TASKS.json: how Blender reads materials, as numbers and as
# pictures. A task is {kind, out, width, height, ...}; a line "WEFT {...}" a task comes out.
#   kind "glb": file; "images": diffuse, normal and optionally rough, of one size; the plane is as large as the
#   resolution of `diffuse` says
#   shows "passes": an orthographic view of the cloth, one texel a pixel, passes of colour and normals
#   shows "picture": the same view under a lamp from the upper left
import numpy

numpy.bool = bool  # the importer of 3.4 asks numpy 1.24 for it

import json
import math
import sys

import bpy
import mathutils


def import_glb(task):
    bpy.ops.import_scene.gltf(filepath=task['file'])


def image_node(nodes, file, space):
    node = nodes.new('ShaderNodeTexImage')
    node.image = bpy.data.images.load(file)
    node.image.colorspace_settings.name = space
    node.interpolation = 'Closest'
    return node


def build_plane(task):
    material = bpy.data.materials.new('cloth')
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    surface = nodes['Principled BSDF']
    diffuse = image_node(nodes, task['diffuse'], 'sRGB')
    links.new(diffuse.outputs['Color'], surface.inputs['Base Color'])
    bump = nodes.new('ShaderNodeNormalMap')
    links.new(image_node(nodes, task['normal'], 'Non-Color').outputs['Color'], bump.inputs['Color'])
    links.new(bump.outputs['Normal'], surface.inputs['Normal'])
    if task.get('rough'):
        links.new(image_node(nodes, task['rough'], 'Non-Color').outputs['Color'], surface.inputs['Roughness'])
    image = diffuse.image
    per_metre = [value if value > 0 else 1000 for value in image.resolution]
    width, height = (image.size[axis] / per_metre[axis] for axis in (0, 1))
    mesh = bpy.data.meshes.new('cloth')
    mesh.from_pydata([(0, 0, 0), (width, 0, 0), (width, 0, height), (0, 0, height)], [], [(0, 1, 2, 3)])
    uv = mesh.uv_layers.new()
    for corner, place in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)]):
        uv.data[corner].uv = place
    mesh.materials.append(material)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new('cloth', mesh))


def cloth():
    return next(thing for thing in bpy.context.scene.objects if thing.type == 'MESH')


def corners(thing):
    return [thing.matrix_world @ mathutils.Vector(corner) for corner in thing.bound_box]


def look_at_it(task):
    scene = bpy.context.scene
    places = corners(cloth())
    least = [min(place[axis] for place in places) for axis in range(3)]
    most = [max(place[axis] for place in places) for axis in range(3)]
    camera = bpy.data.cameras.new('camera')
    camera.type = 'ORTHO'
    camera.ortho_scale = max(most[0] - least[0], most[2] - least[2])
    camera.clip_start = 1e-4
    thing = bpy.data.objects.new('camera', camera)
    thing.location = [(least[axis] + most[axis]) / 2 for axis in range(3)]
    thing.location[1] -= 1
    thing.rotation_euler = (math.pi / 2, 0, 0)
    scene.collection.objects.link(thing)
    scene.camera = thing
    scene.render.engine = 'CYCLES'
    scene.render.resolution_x, scene.render.resolution_y = task['width'], task['height']
    scene.render.resolution_percentage = 100
    scene.render.filepath = task['out']
    scene.render.dither_intensity = 0
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.seed = 1
    return [most[axis] - least[axis] for axis in (0, 2)]


def world(strength):
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new('world')
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes['Background']
    background.inputs['Color'].default_value = (1, 1, 1, 1)
    background.inputs['Strength'].default_value = strength


def passes():
    scene = bpy.context.scene
    scene.cycles.samples = 1
    scene.cycles.pixel_filter_type = 'BOX'
    scene.cycles.filter_width = 0.01
    scene.view_layers[0].use_pass_diffuse_color = True
    scene.view_layers[0].use_pass_normal = True
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.exr_codec = 'OPEN_EXR_MULTILAYER', '32', 'ZIP'
    world(1)


def picture(samples):
    scene = bpy.context.scene
    scene.cycles.samples = samples
    scene.cycles.pixel_filter_type = 'BOX'
    scene.cycles.filter_width = 1
    scene.view_settings.view_transform = 'Standard'
    scene.render.image_settings.file_format = 'PNG'
    lamp = bpy.data.lights.new('lamp', 'SUN')
    lamp.energy = 3
    thing = bpy.data.objects.new('lamp', lamp)
    thing.rotation_euler = mathutils.Vector((1, 1, -1)).to_track_quat('-Z', 'Y').to_euler()
    scene.collection.objects.link(thing)
    world(0.15)


def run(task):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if task['kind'] == 'glb':
        import_glb(task)
    else:
        build_plane(task)
    for image in bpy.data.images:
        image.use_fake_user = True
    size_m = look_at_it(task)
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.use_nodes else []:
            if node.type == 'TEX_IMAGE':
                node.interpolation = 'Closest'
    if task['shows'] == 'passes':
        passes()
    else:
        picture(task.get('samples', 8))
    bpy.ops.render.render(write_still=True)
    spaces = {image.name: image.colorspace_settings.name for image in bpy.data.images if image.size[0]}
    return {'size_m': size_m, 'spaces': spaces}


with open(sys.argv[sys.argv.index('--') + 1], encoding='utf-8') as file:
    tasks = json.load(file)
for task in tasks:
    try:
        print('WEFT ' + json.dumps(run(task)), flush=True)
    except Exception as error:  # one file that Blender cannot read says nothing of the next
        print('WEFT ' + json.dumps({'error': f'{type(error).__name__}: {error}'}), flush=True)
