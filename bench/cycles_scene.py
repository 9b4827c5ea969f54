"""Inside of Blender: builds what scene_twin told of a scene, and renders it with Cycles. Started by bench/compare_cycles:

blender -b --factory-startup --python bench/cycles_scene.py -- JOB.json

Crescente's y points up, Blender's z: (x, y, z) becomes (x, -z, y).

Materials ("materials" of the job): "twin" builds what Crescente computes of nodes that mean the same: a Lambert lobe under a layer of facets that lets through
what it does not reflect towards the viewer, metal beside it, glass, a coat. "principled" leaves it to Blender's Principled BSDF, as its importer would.
"""
import json
import math
import resource
import sys
import time
from pathlib import Path

import bpy
import numpy
from mathutils import Matrix, Vector

SPHERE_SEGMENTS = 512
SCHLICK_SPECULAR = ((1.28 - 1) / (1.28 + 1)) ** 2 / 0.08


def turned(v):
    return Vector((v[0], -v[2], v[1]))


def matrix_of(at):
    x, y, z, origin = (turned(v) for v in at)
    columns = [x, -z, y, origin]  # of Blender's axes: its y is -z here, its z is y
    return Matrix([[c[row] for c in columns] for row in range(3)] + [[0, 0, 0, 1]])


def facing(position, direction, up):
    """What looks along its -z, with y up, as Blender's cameras and lights do."""
    back = -turned(direction).normalized()
    side = turned(up).cross(back).normalized()
    top = back.cross(side)
    place = turned(position)
    return Matrix([[side[k], top[k], back[k], place[k]] for k in range(3)] + [[0, 0, 0, 1]])


# Node trees are written as expressions.
class Nodes:
    def __init__(self, tree):
        self.tree = tree

    def node(self, kind, inputs=None, **fields):
        made = self.tree.nodes.new(kind)
        for name, value in fields.items():
            setattr(made, name, value)
        for name, value in (inputs or {}).items():
            self.put(made.inputs[name], value)
        return made

    def put(self, socket, value):
        if hasattr(value, "is_output"):
            self.tree.links.new(value, socket)
        elif value is not None:
            if not isinstance(value, (int, float, str)) and len(value) == 3 and len(socket.default_value) == 4:
                value = (*value, 1)
            socket.default_value = value

    def math(self, operation, a, b=None):
        made = self.node("ShaderNodeMath", operation=operation)
        self.put(made.inputs[0], a)
        if b is not None:
            self.put(made.inputs[1], b)
        return made.outputs[0]

    def scaled(self, color, factor):
        made = self.node("ShaderNodeVectorMath", operation="SCALE")
        self.put(made.inputs[0], color)
        self.put(made.inputs["Scale"], factor)
        return made.outputs[0]

    def mixed_colors(self, factor, a, b):
        made = self.node("ShaderNodeMixRGB", {"Fac": factor, "Color1": a, "Color2": b})
        return made.outputs[0]

    def added(self, a, b):
        made = self.node("ShaderNodeAddShader")
        self.put(made.inputs[0], a), self.put(made.inputs[1], b)
        return made.outputs[0]

    def mixed(self, factor, a, b):
        made = self.node("ShaderNodeMixShader")
        self.put(made.inputs[0], factor), self.put(made.inputs[1], a), self.put(made.inputs[2], b)
        return made.outputs[0]


def is_number(value):
    return isinstance(value, (int, float))


def layer_image(table):
    size = round(math.sqrt(len(table)))
    image = bpy.data.images.new("layer", size, size, float_buffer=True, is_data=True)
    pixels = numpy.zeros((len(table), 4), numpy.float32)
    pixels[:, :2] = table
    pixels[:, 3] = 1
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return image


def build_twin(n, m, layer):
    """m: inputs by name, each a value or a socket. Returns the shader's socket.

    Facets of dielectrics reflect after Fresnel's equations in both, those of metals by Schlick's approximation in Crescente, as glTF has it. The Principled BSDF of a metal goes from its color to white as
    Fresnel's equations do for the index that its Specular stands for: with 1.28 this is nearest to Schlick's fifth power (0.035 and 0.18 at 60 and 75 degrees; 0.031 and 0.22).
    """
    size = layer.size[0]
    metallic, roughness, color, normal = m["metallic"], m["roughness"], m["base_color"], m.get("normal")
    at = n.node("ShaderNodeNewGeometry")
    dot = n.node("ShaderNodeVectorMath", operation="DOT_PRODUCT")
    n.put(dot.inputs[0], at.outputs["Incoming"]), n.put(dot.inputs[1], normal or at.outputs["Normal"])
    cosine = n.math("ABSOLUTE", dot.outputs["Value"])

    def texel(value):
        return n.math("ADD", n.math("MULTIPLY", value, (size - 1) / size), 0.5 / size)

    place = n.node("ShaderNodeCombineXYZ", {"X": texel(n.math("SQRT", cosine)), "Y": texel(roughness)})
    seen = n.node("ShaderNodeTexImage", {"Vector": place.outputs[0]}, image=layer, extension="EXTEND", interpolation="Linear")
    sums = n.node("ShaderNodeSeparateRGB", {"Image": seen.outputs["Color"]})
    f0 = ((m["ior"] - 1) / (m["ior"] + 1)) ** 2
    kept = n.math("ADD", n.math("MULTIPLY", sums.outputs["R"], f0), sums.outputs["G"])
    lets_in = n.math("SUBTRACT", 1, kept) if f0 > 0 else 1
    normal_input = {"Normal": normal} if normal else {}

    def facets(color):
        inputs = {"Metallic": 1, "Specular": SCHLICK_SPECULAR, "Roughness": roughness, "Clearcoat": 0, "Sheen": 0, "Base Color": color}
        return n.node("ShaderNodeBsdfPrincipled", {**inputs, **normal_input}, distribution="MULTI_GGX").outputs["BSDF"]

    def layer_facets():
        inputs = {"Metallic": 0, "Specular": f0 / 0.08, "Specular Tint": 0, "Roughness": roughness, "Clearcoat": 0, "Sheen": 0, "Base Color": (0, 0, 0)}
        return n.node("ShaderNodeBsdfPrincipled", {**inputs, **normal_input}, distribution="GGX").outputs["BSDF"]

    shader = None
    if not is_number(metallic) or metallic < 1:
        diffuse = n.node("ShaderNodeBsdfDiffuse", {"Color": n.scaled(color, lets_in), "Roughness": 0, **normal_input}).outputs[0]
        if m["transmission"] > 0:
            glass = n.node("ShaderNodeBsdfGlass", {"Color": color, "Roughness": roughness, "IOR": m["ior"], **normal_input}, distribution="MULTI_GGX").outputs[0]
            shader = glass if m["transmission"] == 1 else n.mixed(m["transmission"], n.added(diffuse, layer_facets()), glass)
        else:
            shader = n.added(diffuse, layer_facets()) if f0 > 0 else diffuse
    if not is_number(metallic) or metallic > 0:
        metal = facets(color)
        shader = metal if shader is None else n.mixed(metallic, shader, metal)
    if m["clearcoat"] > 0:
        coat = n.node("ShaderNodeBsdfGlossy", {"Color": (1, 1, 1), "Roughness": m["clearcoat_roughness"], **normal_input}, distribution="GGX").outputs[0]
        fresnel = n.node("ShaderNodeFresnel", {"IOR": 1.5, **normal_input}).outputs[0]
        shader = n.mixed(n.math("MULTIPLY", fresnel, m["clearcoat"]), shader, coat)
    return with_emission_and_opacity(n, m, shader)


def build_principled(n, m, _):
    f0 = ((m["ior"] - 1) / (m["ior"] + 1)) ** 2
    inputs = {"Base Color": m["base_color"], "Metallic": m["metallic"], "Roughness": m["roughness"], "Specular": f0 / 0.08, "IOR": m["ior"], "Transmission": m["transmission"],
              "Clearcoat": m["clearcoat"], "Clearcoat Roughness": m["clearcoat_roughness"]}
    if m.get("normal"):
        inputs["Normal"] = m["normal"]
    return with_emission_and_opacity(n, m, n.node("ShaderNodeBsdfPrincipled", inputs, distribution="MULTI_GGX").outputs["BSDF"])


def with_emission_and_opacity(n, m, shader):
    emissive = m["emissive"]
    if hasattr(emissive, "is_output") or max(emissive) > 0:
        shader = n.added(shader, n.node("ShaderNodeEmission", {"Color": emissive, "Strength": m.get("emissive_strength", 1)}).outputs[0])
    if not is_number(m["opacity"]) or m["opacity"] < 1:
        shader = n.mixed(m["opacity"], n.node("ShaderNodeBsdfTransparent").outputs[0], shader)
    return shader


def material_of(m, build, layer):
    made = bpy.data.materials.new(m["name"])
    made.use_nodes = True
    made.node_tree.nodes.clear()
    n = Nodes(made.node_tree)
    n.node("ShaderNodeOutputMaterial", {"Surface": build(n, m, layer)})
    return made


def rebuild_imported(material, layer):
    """Of a material of Blender's glTF importer: the same inputs on the twin's nodes."""
    tree = material.node_tree
    principled = next((x for x in tree.nodes if x.bl_idname == "ShaderNodeBsdfPrincipled"), None)
    if principled is None:
        return

    def value(name):
        socket = principled.inputs[name]
        if socket.is_linked:
            return socket.links[0].from_socket
        default = socket.default_value
        return default if is_number(default) else tuple(default)[:3]

    normal = principled.inputs["Normal"]
    m = {"base_color": value("Base Color"), "metallic": value("Metallic"), "roughness": value("Roughness"), "ior": 1.5, "transmission": value("Transmission"),
         "emissive": value("Emission"), "emissive_strength": value("Emission Strength"), "clearcoat": value("Clearcoat"), "clearcoat_roughness": value("Clearcoat Roughness"),
         "opacity": value("Alpha"), "normal": normal.links[0].from_socket if normal.is_linked else None}
    n = Nodes(tree)
    output = next(x for x in tree.nodes if x.bl_idname == "ShaderNodeOutputMaterial")
    n.put(output.inputs["Surface"], build_twin(n, m, layer))


def mesh_of(shape, numbers, name):
    mesh = bpy.data.meshes.new(name)
    kind = shape["kind"]
    if kind == "mesh":
        v, t, at = shape["vertices"], shape["triangles"], shape["at"]
        positions = numbers[at:at + 3 * v].view(numpy.float32).reshape(-1, 3)[:, [0, 2, 1]] * numpy.float32([1, -1, 1])
        corners = numbers[at + 3 * v:at + 3 * v + 3 * t]
        slots = numbers[at + 3 * (v + t):at + 3 * (v + t) + t]
        mesh.vertices.add(v), mesh.loops.add(3 * t), mesh.polygons.add(t)
        mesh.vertices.foreach_set("co", positions.ravel())
        mesh.loops.foreach_set("vertex_index", corners.astype(numpy.int32))
        mesh.polygons.foreach_set("loop_start", numpy.arange(0, 3 * t, 3, dtype=numpy.int32))
        mesh.polygons.foreach_set("loop_total", numpy.full(t, 3, numpy.int32))
        mesh.polygons.foreach_set("material_index", slots.astype(numpy.int32))
        mesh.update(), mesh.validate()
        if shape["normals"]:
            normals = numbers[at + 3 * v + 4 * t:at + 3 * v + 13 * t].view(numpy.float32).reshape(-1, 3)[:, [0, 2, 1]] * numpy.float32([1, -1, 1])
            if len(mesh.loops) == len(normals):
                mesh.polygons.foreach_set("use_smooth", numpy.ones(t, bool))
                mesh.use_auto_smooth = True
                mesh.normals_split_custom_set(normals.tolist())
    elif kind == "box":
        (x0, y0, z0), (x1, y1, z1) = shape["lower"], shape["upper"]
        points = [turned((x, y, z)) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)]
        mesh.from_pydata(points, [], [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    elif kind == "disk":
        r = shape["radius"]
        mesh.from_pydata([(r * math.cos(a), r * math.sin(a), 0) for a in numpy.linspace(0, 2 * math.pi, SPHERE_SEGMENTS, endpoint=False)], [], [tuple(range(SPHERE_SEGMENTS))])
    elif kind == "sphere":
        import bmesh
        made = bmesh.new()
        bmesh.ops.create_uvsphere(made, u_segments=SPHERE_SEGMENTS, v_segments=SPHERE_SEGMENTS // 2, radius=shape["radius"])
        made.to_mesh(mesh)
        mesh.polygons.foreach_set("use_smooth", numpy.ones(len(mesh.polygons), bool))
    return mesh


def add(name, data, matrix):
    made = bpy.data.objects.new(name, data)
    made.matrix_world = matrix
    bpy.context.scene.collection.objects.link(made)
    return made


def build_objects(told, numbers, build, layer):
    materials = [material_of(m, build, layer) for m in told["materials"]]
    default = material_of({"name": "default", "base_color": (0.8, 0.8, 0.8), "metallic": 0, "roughness": 0.5, "emissive": (0, 0, 0), "ior": 1.5, "transmission": 0, "clearcoat": 0,
                           "clearcoat_roughness": 0, "opacity": 1}, build, layer)
    meshes = {}
    for o in told["objects"]:
        slots = tuple(o["materials"])
        key = o["shape"], slots
        if key not in meshes:
            meshes[key] = mesh_of(told["shapes"][o["shape"]], numbers, o["name"])
            for slot in slots or (None,):
                meshes[key].materials.append(default if slot is None else materials[slot])
        add(o["name"], meshes[key], matrix_of(o["to_world"]))


def build_camera(told, size):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle_y = "VERTICAL", told["field_of_view"]
    camera.sensor_fit = "VERTICAL"
    camera.lens = camera.sensor_height / (2 * math.tan(told["field_of_view"] / 2))
    direction = [t - p for t, p in zip(told["target"], told["position"])]
    distance = math.sqrt(sum(d * d for d in direction))
    camera.clip_start, camera.clip_end = 1e-4 * distance, 1e4 * distance
    bpy.context.scene.camera = add("camera", camera, facing(told["position"], direction, told["up"]))


def build_lights(lights):
    for told in lights:
        light = bpy.data.lights.new(told["name"], "AREA")
        light.shape, light.size, light.size_y = "RECTANGLE", told["width"], told["height"]
        strongest = max(told["radiance"])
        light.color = [c / strongest for c in told["radiance"]]
        light.energy = 4 * strongest * told["width"] * told["height"]
        light.cycles.use_multiple_importance_sampling = True
        light.cycles.max_bounces = 1024
        add(told["name"], light, facing(told["position"], told["direction"], told["up"])).visible_camera = told["visible"]


def build_world(told):
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world = world
    world.use_nodes = True
    world.node_tree.nodes.clear()
    n = Nodes(world.node_tree)
    coordinates = n.node("ShaderNodeTexCoord")
    if told is None:
        color, strength = (0, 0, 0), 0
    elif told["image"]:
        turn = n.node("ShaderNodeMapping", {"Vector": coordinates.outputs["Generated"], "Rotation": (0, 0, -told["rotation"])})
        picture = bpy.data.images.load(told["image"])
        color, strength = n.node("ShaderNodeTexEnvironment", {"Vector": turn.outputs[0]}, image=picture).outputs[0], told["intensity"]
    else:
        z = n.node("ShaderNodeSeparateXYZ", {"Vector": coordinates.outputs["Generated"]}).outputs["Z"]
        end = n.mixed_colors(n.math("GREATER_THAN", z, 0), told["nadir"], told["zenith"])
        color, strength = n.mixed_colors(n.math("ABSOLUTE", z), told["horizon"], end), told["strength"]
    background = n.node("ShaderNodeBackground", {"Color": color, "Strength": strength}).outputs[0]
    if told and told["backdrop"]:
        height = n.node("ShaderNodeSeparateXYZ", {"Vector": coordinates.outputs["Window"]}).outputs["Y"]
        behind = n.node("ShaderNodeBackground", {"Color": n.mixed_colors(height, told["backdrop_bottom"], told["backdrop_top"])}).outputs[0]
        background = n.mixed(n.node("ShaderNodeLightPath").outputs["Is Camera Ray"], background, behind)
    n.node("ShaderNodeOutputWorld", {"Surface": background})
    world.cycles.sampling_method = "AUTOMATIC"


def set_up(job, told):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = told["size"]
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads = "FIXED", job["threads"]
    scene.render.use_persistent_data = False
    scene.render.film_transparent = False
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGB"
    scene.view_settings.view_transform = "Raw"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    depth = job["depth"]
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = cycles.transparent_max_bounces = depth
    for o in scene.objects:
        if o.type == "MESH":
            o.cycles.shadow_terminator_offset = o.cycles.shadow_terminator_geometry_offset = 0


def processor_seconds():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def main():
    job = json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text())
    folder = Path(job["folder"])
    told = json.loads((folder / "scene.json").read_text())
    numbers = numpy.fromfile(folder / "meshes.bin", numpy.uint32)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    layer = layer_image(told["layer"])
    if job["import"]:
        numpy.bool = bool  # the importer of 3.4 asks for the name that NumPy 1.24 took away
        bpy.ops.import_scene.gltf(filepath=job["import"])
        for o in list(bpy.context.scene.objects):
            if o.type in ("LIGHT", "CAMERA"):
                bpy.data.objects.remove(o)
            elif o.type == "ARMATURE":
                o.data.pose_position = "REST"  # not in the middle of an animation
        if job["materials"] == "twin":
            for material in bpy.data.materials:
                if material.use_nodes:
                    rebuild_imported(material, layer)
    else:
        build_objects(told, numbers, build_twin if job["materials"] == "twin" else build_principled, layer)
    build_camera(told["camera"], told["size"])
    build_lights(told["lights"])
    build_world(told.get("environment"))
    set_up(job, told)
    cycles = bpy.context.scene.cycles
    for picture in job["pictures"]:
        cycles.samples, cycles.time_limit = picture.get("samples", 1 << 20), picture.get("seconds", 0)
        cycles.use_adaptive_sampling = picture.get("adaptive", False)
        cycles.adaptive_threshold = picture.get("noise", 0.01)
        cycles.seed = picture.get("seed", 0)
        bpy.context.scene.render.filepath = picture["file"]
        start, processor = time.monotonic(), processor_seconds()
        bpy.ops.render.render(write_still=True)
        print("PICTURE", json.dumps({"file": picture["file"], "wall": time.monotonic() - start, "processor": processor_seconds() - processor}), flush=True)


main()
