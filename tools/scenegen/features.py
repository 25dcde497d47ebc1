# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Makes one small scene for each feature. Each function is named after its file."""

import math

from . import meshes
from .gltf import TRIANGLE_FAN, TRIANGLE_STRIP, Gltf
from .vectors import axis_rotation, normalize, quaternion_about

# Colours are linear RGB.
CREAM = (0.75, 0.68, 0.56)
CORAL = (0.8, 0.2, 0.13)
AMBER = (0.85, 0.45, 0.08)
LEAF = (0.2, 0.5, 0.16)
TEAL = (0.06, 0.42, 0.42)
AZURE = (0.1, 0.28, 0.7)
PLUM = (0.36, 0.1, 0.4)
STONE = (0.45, 0.45, 0.47)
SLATE = (0.16, 0.18, 0.22)
SKY = (0.42, 0.56, 0.7)
PALETTE = {"coral": CORAL, "amber": AMBER, "leaf": LEAF, "teal": TEAL, "azure": AZURE, "plum": PLUM}


def _stage(floor=CREAM, background=SKY, ambient=0.25, key=0.75):
    """A scene with an infinite floor at y = 0, a sky and, with key > 0, one directional source from the upper left."""
    g = Gltf()
    g.sky(background, (ambient,) * 3)
    g.node("floor", mesh=g.plane("floor", g.material("floor", floor)))
    if key:
        g.directional_light("sun", (0.55, -1.0, -0.5), intensity=key)
    return g


def _glossy(g, name, color):
    return g.material(name, color, specular=0.4, shininess=40.0)


def sphere():
    """Spheres of three radii on the floor."""
    g = _stage()
    for name, color, radius, x, z in (
        ("large", CORAL, 1.0, -0.9, -0.4),
        ("middle", TEAL, 0.6, 0.85, 0.1),
        ("small", AMBER, 0.3, 0.1, 0.9),
    ):
        g.node(name, mesh=g.sphere(name, radius, _glossy(g, name, color)), translation=(x, radius, z))
    g.camera("camera", (0.0, 2.0, 5.6), (0.0, 0.75, 0.0))
    return g


def plane():
    """Two infinite planes, a floor and a tilted wall; a row of spheres runs to the horizon."""
    g = _stage(background=(0.55, 0.65, 0.75), key=0.0)
    g.directional_light("sun", (-0.5, -1.0, -0.6), intensity=0.75)
    wall = g.plane("wall", g.material("wall", TEAL))
    g.node("wall", mesh=wall, translation=(-4.0, 0.0, 0.0), rotation=quaternion_about((0.0, 0.0, 1.0), -65.0))
    ball = g.sphere("ball", 0.5, _glossy(g, "ball", CORAL))
    for i in range(12):
        g.node(f"ball {i}", mesh=ball, translation=(0.8, 0.5, 2.6 - 1.2 * 1.45**i))
    g.camera("camera", (3.0, 2.2, 6.0), (-0.1, 0.75, -1.5))
    return g


def cylinder():
    """A pillar, a disc and two lying rods: side and both caps are seen."""
    g = _stage()
    pillar = g.cylinder("pillar", 2.2, 0.4, _glossy(g, "pillar", AZURE))
    g.node("pillar", mesh=pillar, translation=(-1.1, 1.1, -0.5))
    disc = g.cylinder("disc", 0.3, 1.0, _glossy(g, "disc", AMBER))
    g.node("disc", mesh=disc, translation=(0.9, 0.15, -0.3))
    rod = g.cylinder("rod", 2.4, 0.18, _glossy(g, "rod", CORAL))
    g.node("leaning rod", mesh=rod, translation=(0.9, 1.29, -0.3), rotation=axis_rotation((0.45, 1.0, 0.1)))
    g.node("lying rod", mesh=rod, translation=(-0.1, 0.18, 1.1), rotation=axis_rotation((1.0, 0.0, -0.25)))
    g.camera("camera", (0.6, 2.8, 6.0), (0.15, 0.95, 0.0))
    return g


def cone():
    """Cones upright, lying and inverted, and a frustum: side, base and top are seen."""
    g = _stage()
    upright = g.cone("cone", 1.8, 0.7, _glossy(g, "cone", CORAL))
    g.node("upright", mesh=upright, translation=(-1.6, 0.9, -0.4))
    frustum = g.frustum("frustum", 1.0, 0.75, 0.4, _glossy(g, "frustum", TEAL))
    g.node("frustum", mesh=frustum, translation=(0.25, 0.5, -0.6))
    small = g.cone("small", 0.9, 0.4, _glossy(g, "small", AMBER))
    g.node("standing on its apex", mesh=small, translation=(0.25, 1.45, -0.6), rotation=(1.0, 0.0, 0.0, 0.0))
    # A cone lies on its side if its axis dips by half its opening angle.
    dip = math.atan2(0.4, 0.9)
    for name, x, z, yaw_deg in (("lying", 1.75, 0.5, 20.0), ("shows its base", -0.3, 1.3, 125.0)):
        yaw = math.radians(yaw_deg)
        axis = (math.cos(dip) * math.cos(yaw), -math.sin(dip), -math.cos(dip) * math.sin(yaw))
        g.node(name, mesh=small, translation=(x, 0.45 * math.sin(dip), z), rotation=axis_rotation(axis))
    g.camera("camera", (0.5, 2.4, 5.8), (0.1, 0.8, 0.0))
    return g


def box():
    """Boxes upright, turned and on a corner, a plate, and one in a mirror: all kinds of faces and edges are seen."""
    g = _stage()
    cube = g.box("cube", (0.9, 0.9, 0.9), _glossy(g, "cube", CORAL))
    g.node("cube", mesh=cube, translation=(-1.5, 0.45, 0.3), rotation=quaternion_about((0.0, 1.0, 0.0), 30.0))
    tilt = axis_rotation((1.0, 1.0, 1.0))
    g.node("on its corner", mesh=cube, translation=(0.1, 0.78, 0.0), rotation=tilt, scale=0.85)
    slab = g.box("slab", (1.6, 0.2, 0.9), _glossy(g, "slab", TEAL))
    g.node("slab", mesh=slab, translation=(1.75, 0.1, 0.5), rotation=quaternion_about((0.0, 1.0, 0.0), -20.0))
    g.node("stretched", mesh=cube, translation=(1.7, 0.6, 0.45), scale=(0.5, 0.9, 0.4))
    plate = g.box("plate", (4.6, 2.0, 0.02), g.material("plate", SLATE, specular=0.3, shininess=80.0, reflection=0.6))
    g.node("plate", mesh=plate, translation=(0.2, 1.0, -1.5), rotation=quaternion_about((0.0, 1.0, 0.0), 8.0))
    g.camera("camera", (0.5, 2.1, 5.6), (0.1, 0.75, 0.0))
    return g


def capsule():
    """Capsules upright, lying and leaning, of two radii, a pointed one, one whose lower end nearly holds the other."""
    g = _stage()
    pill = g.capsule("pill", 1.0, 0.4, 0.4, _glossy(g, "pill", CORAL))
    g.node("upright", mesh=pill, translation=(-1.9, 0.9, -0.5))
    g.node("lying", mesh=pill, translation=(-1.3, 0.3, 1.2), rotation=axis_rotation((1.0, 0.0, -0.4)), scale=0.75)
    skittle = g.capsule("skittle", 1.1, 0.5, 0.2, _glossy(g, "skittle", TEAL))
    g.node("skittle", mesh=skittle, translation=(-0.3, 1.05, -0.4))
    drop = g.capsule("drop", 1.2, 0.4, 0.0, _glossy(g, "drop", AMBER))
    g.node("pointed", mesh=drop, translation=(0.9, 1.0, -0.2))
    egg = g.capsule("egg", 0.32, 0.5, 0.2, g.material("egg", SLATE, specular=0.4, shininess=60.0, reflection=0.5))
    g.node("egg", mesh=egg, translation=(2.0, 0.66, 0.2))
    g.node("leaning", mesh=skittle, translation=(0.6, 0.45, 1.2), rotation=axis_rotation((0.9, 0.35, 0.3)), scale=0.6)
    g.camera("camera", (0.5, 2.1, 5.8), (0.05, 0.75, 0.0))
    return g


def triangles_sharp():
    """Meshes without normals: every face is flat."""
    g = _stage()
    solids = (
        ("octahedron", meshes.octahedron(0.8), CORAL, (-1.9, 0.8, -0.2)),
        ("icosahedron", meshes.icosahedron(0.85), TEAL, (0.0, 0.72, 0.2)),
        ("star", meshes.stellated(meshes.icosahedron(0.5), 0.6), AMBER, (1.95, 0.75, -0.3)),
    )
    for name, mesh, color, place in solids:
        rotation = quaternion_about((0.2, 1.0, 0.1), 25.0)
        g.node(name, mesh=g.mesh(name, mesh, _glossy(g, name, color)), translation=place, rotation=rotation)
    g.camera("camera", (0.4, 1.9, 5.4), (0.0, 0.7, 0.0))
    return g


def triangles_smooth():
    """The same coarse meshes twice: flat behind, with interpolated vertex normals in front."""
    g = _stage()
    forms = (("torus", meshes.torus(0.62, 0.25, 18, 9), 0.62, -1.1), ("ball", meshes.icosphere(0.7, 1), 0.68, 1.1))
    for name, smooth_mesh, height, x in forms:
        smooth_mesh = meshes.smooth(smooth_mesh)
        flat_mesh = meshes.Mesh(smooth_mesh.positions, smooth_mesh.indices)
        rotation = quaternion_about((1.0, 0.25, 0.0), 65.0)
        for kind, mesh, color, z, y in (
            ("flat", flat_mesh, STONE, -1.7, height + 0.5),
            ("smooth", smooth_mesh, CORAL, 0.4, height),
        ):
            node = g.mesh(f"{kind} {name}", mesh, _glossy(g, f"{kind} {name}", color))
            g.node(f"{kind} {name}", mesh=node, translation=(x, y, z), rotation=rotation)
    pedestal = g.cylinder("pedestal", 0.5, 0.8, g.material("pedestal", SLATE))
    for x in (-1.1, 1.1):
        g.node("pedestal", mesh=pedestal, translation=(x, 0.25, -1.7))
    g.camera("camera", (0.0, 2.3, 5.2), (0.0, 0.85, -0.4))
    return g


def strip_and_fan():
    """A wavy ribbon as one triangle strip, and an open parasol as one triangle fan."""
    g = _stage()
    ribbon = []
    for i in range(49):
        angle = math.tau * i / 48 * 1.5
        x, z = -2.4 + 3.4 * i / 48, 0.5 * math.sin(angle)
        ribbon += [(x, 0.0, z), (x, 0.9, z)]
    mesh = meshes.Mesh(ribbon, list(range(len(ribbon))))
    g.node("strip", mesh=g.mesh("strip", mesh, _glossy(g, "strip", TEAL), TRIANGLE_STRIP))
    rim = [(math.sin(math.tau * i / 12), -0.45 + 0.12 * (i % 2), math.cos(math.tau * i / 12)) for i in range(12)]
    mesh = meshes.Mesh([(0.0, 0.0, 0.0), *rim], [0, *range(1, 13), 1])
    fan = g.mesh("fan", mesh, _glossy(g, "fan", CORAL), TRIANGLE_FAN)
    g.node("fan", mesh=fan, translation=(1.5, 1.35, 0.7), rotation=quaternion_about((1.0, 0.0, -0.4), 20.0), scale=0.8)
    stick = g.cylinder("stick", 1.3, 0.03, g.material("stick", SLATE))
    g.node("stick", mesh=stick, translation=(1.37, 0.74, 0.48), rotation=quaternion_about((1.0, 0.0, -0.4), 20.0))
    g.camera("camera", (0.0, 2.4, 5.0), (0.0, 0.65, 0.0))
    return g


def vertex_colors():
    """A colour cube and a torus whose colours run around it."""
    g = _stage()
    material = g.material("white", (1.0, 1.0, 1.0), specular=0.2, shininess=30.0)
    cube = meshes.box(1.2, 1.2, 1.2)
    cube.colors = [tuple(0.05 + 0.85 * (x > 0) for x in p) for p in cube.positions]
    rotation = quaternion_about((0.0, 1.0, 0.0), 35.0)
    g.node("cube", mesh=g.mesh("cube", cube, material), translation=(-1.2, 0.6, 0.0), rotation=rotation)
    torus = meshes.torus(0.75, 0.3, 36, 14)
    for x, y, z in torus.positions:
        angle = math.atan2(x, z)
        torus.colors.append(tuple(0.5 + 0.42 * math.cos(angle + math.tau * k / 3.0) for k in range(3)))
    rotation = quaternion_about((1.0, 0.3, 0.0), 60.0)
    g.node("torus", mesh=g.mesh("torus", torus, material), translation=(1.1, 1.0, 0.0), rotation=rotation)
    g.camera("camera", (0.0, 2.0, 5.0), (0.0, 0.75, 0.0))
    return g


def _lit_subjects(g):
    ball = g.sphere("ball", 0.6, _glossy(g, "ball", CORAL))
    g.node("ball", mesh=ball, translation=(-1.1, 0.6, 0.0))
    g.node("post", mesh=g.cylinder("post", 1.6, 0.25, _glossy(g, "post", TEAL)), translation=(0.9, 0.8, -0.7))
    g.node("cone", mesh=g.cone("cone", 0.8, 0.4, _glossy(g, "cone", AMBER)), translation=(0.6, 0.4, 0.9))


def light_point():
    """One point source between the objects: its shadows fan out from it."""
    g = _stage(background=(0.1, 0.12, 0.16), ambient=0.15, key=0.0)
    _lit_subjects(g)
    g.point_light("lamp", (0.0, 1.5, 0.5), color=(1.0, 0.92, 0.8), intensity=0.9)
    bulb = g.sphere("bulb", 0.06, g.material("bulb", (0.0, 0.0, 0.0), emissive=(1.0, 0.92, 0.8)))
    # The bulb is above the source, so that the source is not inside it.
    g.node("bulb", mesh=bulb, translation=(0.0, 1.57, 0.5))
    g.camera("camera", (0.0, 2.6, 5.2), (0.0, 0.6, 0.0))
    return g


def light_directional():
    """One directional source: its shadows are parallel."""
    g = _stage(ambient=0.2, key=0.0)
    _lit_subjects(g)
    g.directional_light("sun", (1.0, -0.8, -0.45), color=(1.0, 0.95, 0.85), intensity=0.9)
    g.camera("camera", (0.0, 2.6, 5.2), (0.0, 0.6, 0.0))
    return g


def light_spot():
    """Three coloured spots, from a hard to a soft edge; where they overlap their colours add up."""
    g = _stage(floor=(0.7, 0.7, 0.7), background=(0.05, 0.06, 0.09), ambient=0.08, key=0.0)
    for name, color, x, z, inner in (
        ("red", (0.9, 0.12, 0.08), -2.0, 1.0, 17.9),
        ("green", (0.12, 0.8, 0.15), 0.0, -1.8, 12.0),
        ("blue", (0.12, 0.25, 1.0), 2.0, 1.0, 0.0),
    ):
        g.spot_light(name, (x, 4.0, z), (0.5 * x, 0.0, 0.5 * z), inner, 18.0, color=color)
    g.node("ball", mesh=g.sphere("ball", 0.45, _glossy(g, "ball", (0.8, 0.8, 0.8))), translation=(0.0, 0.45, 0.0))
    g.camera("camera", (0.0, 3.8, 5.6), (0.0, 0.1, 0.0))
    return g


def light_physical():
    """Three equal lamps of KHR_lights_punctual at growing height: the light falls off with the distance squared."""
    g = _stage(floor=(0.6, 0.6, 0.6), background=(0.02, 0.025, 0.035), ambient=0.03, key=0.0)
    bulb = g.sphere("bulb", 0.06, g.material("bulb", (0.0, 0.0, 0.0), emissive=(1.0, 0.85, 0.6)))
    post = g.cylinder("post", 0.8, 0.12, _glossy(g, "post", AZURE))
    for i, height in enumerate((0.6, 1.1, 2.0)):
        x = -2.6 + 2.6 * i
        g.point_light(f"lamp {i}", (x, height, 0.0), color=(1.0, 0.85, 0.6), intensity=0.45, classic=False)
        g.node(f"bulb {i}", mesh=bulb, translation=(x, height + 0.07, 0.0))
        g.node(f"post {i}", mesh=post, translation=(x + 0.6, 0.4, -0.6))
    g.camera("camera", (0.0, 3.0, 6.2), (0.0, 0.5, 0.0))
    return g


def ambient_and_background():
    """Only ambient light, in the sky's warm colour: every object has one uniform colour on the plain background."""
    g = Gltf()
    g.sky((0.85, 0.52, 0.3), (0.9, 0.75, 0.65))
    for i, (name, color) in enumerate(PALETTE.items()):
        height = 0.6 + 0.5 * (i % 3)
        post = g.cylinder(name, height, 0.35, g.material(name, color))
        g.node(name, mesh=post, translation=(-2.25 + 0.9 * i, height / 2.0, 0.0))
    # This source is switched off: a scene without any source would get a headlight.
    g.directional_light("off", (0.0, -1.0, 0.0), intensity=0.0)
    g.camera("camera", (0.0, 1.6, 5.6), (0.0, 0.7, 0.0))
    return g


def shadows():
    """Red, green and blue sources: each pillar throws three coloured shadows, black where all three meet."""
    g = _stage(floor=(0.8, 0.8, 0.8), background=(0.25, 0.27, 0.3), ambient=0.08, key=0.0)
    white = _glossy(g, "white", (0.8, 0.8, 0.8))
    pillar, ball = g.cylinder("pillar", 1.2, 0.22, white), g.sphere("ball", 0.4, white)
    for i in range(5):
        angle = math.tau * i / 5
        g.node(f"pillar {i}", mesh=pillar, translation=(1.5 * math.sin(angle), 0.6, 1.5 * math.cos(angle)))
    g.node("ball", mesh=ball, translation=(0.0, 0.4, 0.0))
    g.point_light("red", (-3.0, 4.0, 2.0), color=(0.75, 0.1, 0.1))
    g.point_light("green", (3.0, 4.0, 2.0), color=(0.1, 0.6, 0.1))
    g.directional_light("blue", (0.1, -1.0, 0.9), color=(0.1, 0.2, 0.75))
    g.camera("camera", (0.0, 4.4, 6.4), (0.0, 0.3, 0.1))
    return g


def mirrors():
    """Two facing mirrors repeat the objects between them; a sphere and a cylinder show curved reflections."""
    g = _stage(floor=(0.62, 0.5, 0.36), background=(0.5, 0.64, 0.78))
    mirror = g.material("mirror", (0.02, 0.03, 0.03), reflection=(0.88, 0.92, 0.9))
    frame = g.material("frame", (0.3, 0.12, 0.05), specular=0.3, shininess=20.0)
    glass, back = g.mesh("mirror", meshes.rectangle(3.6, 2.2), mirror), g.mesh(
        "frame", meshes.box(3.8, 0.08, 2.4), frame
    )
    for name, z, turn, yaw in (("far", -1.6, 90.0, 0.0), ("near", 1.9, -90.0, 0.0)):
        rotation = quaternion_about((1.0, 0.0, 0.0), turn)
        inward = 0.05 if z < 0 else -0.05
        g.node(f"{name} mirror", mesh=glass, translation=(0.0, 1.3, z + inward), rotation=rotation)
        g.node(f"{name} frame", mesh=back, translation=(0.0, 1.3, z), rotation=rotation)
    chrome = g.material("chrome", (0.04, 0.04, 0.04), specular=0.6, shininess=120.0, reflection=0.8)
    g.node("chrome ball", mesh=g.sphere("chrome ball", 0.55, chrome), translation=(-0.75, 0.55, 0.0))
    g.node("chrome post", mesh=g.cylinder("chrome post", 1.3, 0.28, chrome), translation=(0.55, 0.65, -0.55))
    g.node("ball", mesh=g.sphere("ball", 0.28, _glossy(g, "ball", CORAL)), translation=(0.05, 0.28, 0.6))
    g.node("cone", mesh=g.cone("cone", 0.7, 0.28, _glossy(g, "cone", AZURE)), translation=(0.6, 0.35, 0.15))
    g.camera("camera", (2.5, 1.9, 1.74), (-0.35, 0.75, -0.75), yfov_deg=55.0)
    return g


def emissive():
    """Lanterns that show their own colour in the dark. They are too weak to light other objects."""
    g = _stage(floor=(0.4, 0.4, 0.42), background=(0.03, 0.035, 0.05), ambient=0.25, key=0.15)
    pole = g.cylinder("pole", 0.6, 0.06, g.material("pole", STONE))
    for i, (name, color) in enumerate(PALETTE.items()):
        glow = tuple(min(1.0, 1.3 * c) for c in color)
        lantern = g.sphere(name, 0.3, g.material(name, (0.02, 0.02, 0.02), emissive=glow))
        angle = math.tau * i / len(PALETTE)
        g.node(name, mesh=lantern, translation=(1.7 * math.sin(angle), 0.85, 1.7 * math.cos(angle)))
        g.node("pole", mesh=pole, translation=(1.7 * math.sin(angle), 0.3, 1.7 * math.cos(angle)))
    column = g.cylinder("mirror column", 1.6, 0.5, g.material("mirror column", (0.03, 0.03, 0.03), reflection=0.8))
    g.node("mirror column", mesh=column, translation=(0.0, 0.8, 0.0))
    g.camera("camera", (0.0, 2.6, 5.6), (0.0, 0.6, 0.0))
    return g


def _cubes(g):
    cube = meshes.box(0.8, 0.8, 0.8)
    boxes = [g.mesh(name, cube, _glossy(g, name, color)) for name, color in PALETTE.items()]
    for x in range(3):
        for z in range(3):
            for y in range(3 - max(x, z)):
                g.node(
                    f"cube {x} {y} {z}",
                    mesh=boxes[(x + 2 * z + 3 * y) % 6],
                    translation=(x - 1.0, y + 0.4 - 0.2 * y, z - 1.0),
                )


def orthographic():
    """Stacked cubes in an isometric view: parallel edges stay parallel."""
    g = _stage()
    _cubes(g)
    g.orthographic_camera("isometric", (6.0, 5.7, 6.0), (0.0, 1.0, 0.0), 2.3)
    return g


def cameras():
    """Five cameras on one scene: front, side, top (orthographic), wide at a corner, narrow from afar."""
    g = _stage()
    _cubes(g)
    g.camera("front", (-1.2, 2.4, 6.0), (0.0, 0.8, 0.0))
    g.camera("side", (6.0, 2.2, 1.5), (0.0, 0.8, 0.0))
    g.orthographic_camera("top", (0.0, 8.0, 0.0), (0.0, 0.0, 0.0), 1.9)
    g.camera("wide", (2.4, 1.7, 2.4), (0.0, 0.7, 0.0), yfov_deg=85.0)
    g.camera("narrow", (16.0, 9.0, 20.0), (0.0, 0.8, 0.0), yfov_deg=9.0, aspect_ratio=4.0 / 3.0)
    return g


def metallic_roughness():
    """Core glTF materials: metals behind, dielectrics in front, rougher to the right."""
    g = _stage(floor=SLATE)
    for row, (metallic, color) in enumerate(((0.0, CORAL), (1.0, (0.95, 0.7, 0.3)))):
        for column in range(5):
            name = f"metallic {metallic:g} roughness {column / 4:g}"
            material = g.metallic_roughness(name, color, metallic, column / 4)
            ball = g.sphere(name, 0.45, material)
            g.node(name, mesh=ball, translation=(-2.2 + 1.1 * column, 0.45, 0.7 - 1.4 * row))
    g.point_light("lamp", (-3.0, 5.0, 4.0), intensity=70.0, classic=False)
    g.camera("camera", (0.0, 2.6, 6.0), (0.0, 0.35, 0.0))
    return g


def glass():
    """Glass: a ball, a bubble in one, a stone that absorbs, a rod, a frosted pane, and one of classic weights."""
    g = Gltf()
    g.sky(SKY, (0.6,) * 3)
    g.node("floor", mesh=g.plane("floor", g.metallic_roughness("floor", CREAM, 0.0, 0.9)))
    g.directional_light("sun", (0.55, -1.0, -0.5), intensity=2.0, classic=False)
    for column, (name, color) in enumerate(PALETTE.items()):
        # These objects are seen through the glass.
        bar = g.box(name, (0.5, 1.6, 0.3), g.metallic_roughness(name, color, 0.0, 0.6))
        g.node(name, mesh=bar, translation=(-2.6 + 1.04 * column, 0.8, -2.4))
    clear = g.glass("clear", absorbed=((0.98, 0.99, 0.98), 2.0))
    g.node("ball", mesh=g.sphere("ball", 0.75, clear), translation=(-1.9, 0.8, 0.2))
    g.node("shell", mesh=g.sphere("shell", 0.6, clear), translation=(-0.35, 0.62, 0.6))
    air = g.glass("air", ior=1.0, absorbed=((1.0, 1.0, 1.0), 1.0))
    g.node("bubble", mesh=g.sphere("bubble", 0.35, air), translation=(-0.35, 0.62, 0.6))
    emerald = g.glass("emerald", ior=1.58, absorbed=((0.12, 0.75, 0.35), 1.2))
    stone = g.mesh("stone", meshes.icosahedron(0.6), emerald)
    g.node("stone", mesh=stone, translation=(0.95, 0.6, 0.4), rotation=axis_rotation((0.2, 1.0, 0.1)))
    rod = g.cylinder("rod", 1.9, 0.22, g.classic_glass("rod", 0.9, 0.1, 1.5))
    g.node("rod", mesh=rod, translation=(2.0, 1.0, -0.3), rotation=axis_rotation((0.25, 1.0, 0.05)))
    frosted = g.glass("frosted", base_color=(0.75, 0.9, 0.95), roughness=0.3)
    pane = g.box("pane", (0.9, 1.1, 0.02), frosted)
    g.node("pane", mesh=pane, translation=(2.35, 0.56, 0.9), rotation=quaternion_about((0.0, 1.0, 0.0), -20.0))
    marble = g.classic_glass("marble", 1.0, 1.0, 1.8, fresnel=True)
    g.node("marble", mesh=g.sphere("marble", 0.28, marble), translation=(0.3, 0.28, 1.5))
    g.camera("camera", (0.2, 2.0, 6.4), (0.15, 0.66, 0.0), yfov_deg=31.0)
    return g


def _leaf(length, width, sag):
    """Returns a leaf along x from the origin, folded along its rib, with triangles on both sides."""
    places = [i / 8 for i in range(9)]
    positions = []
    for t in places:
        half = 0.5 * width * math.sin(math.pi * t) ** 0.75
        rib = (length * t, -sag * t * t, 0.0)
        positions += [rib, (rib[0], rib[1] + 0.35 * half, half), (rib[0], rib[1] + 0.35 * half, -half)]
    triangles = []
    for i in range(8):
        for side in (1, 2):
            a, b, c, d = 3 * i, 3 * i + side, 3 * i + 3, 3 * i + 3 + side
            triangles += [(a, b, d), (a, d, c)] if side == 1 else [(a, d, b), (a, c, d)]
    return meshes.Mesh(positions, [corner for triangle in triangles for corner in triangle])


def _lid(radius, height, rings, columns):
    """Returns a smooth dome that rises from its rim to its middle; u runs around it and v outwards."""
    positions, normals, uvs, indices = [], [], [], []
    for ring in range(rings + 1):
        r = radius * (0.02 + 0.98 * ring / rings)
        slope = 2.0 * height * r / radius**2
        for column in range(columns + 1):
            x, z = math.cos(math.tau * column / columns), math.sin(math.tau * column / columns)
            positions.append((r * x, height * (1.0 - (r / radius) ** 2), r * z))
            normals.append(normalize((slope * x, 1.0, slope * z)))
            uvs.append((column / columns, r / radius))
            if ring < rings and column < columns:
                a = ring * (columns + 1) + column
                b = a + columns + 1
                indices += [a, a + 1, b + 1, a, b + 1, b]
    return meshes.Mesh(positions, indices, normals=normals, uvs=uvs)


def rare_materials():
    """Translucent paper lanterns with lamps inside, leaves in front of the sun, thin films, brushed lids."""
    g = Gltf()
    g.sky((0.1, 0.13, 0.2), (0.1, 0.11, 0.14))
    g.node("floor", mesh=g.plane("floor", g.metallic_roughness("floor", STONE, 0.0, 0.9)))
    g.directional_light("sun", (0.35, -0.8, 1.0), intensity=2.5, classic=False)
    g.directional_light("window", (-0.3, -0.9, -0.5), intensity=1.5, classic=False)
    lanterns = (
        ("white", (0.8, 0.78, 0.72), (1.0, 0.85, 0.6), -1.9, 0.9, 0.7),
        ("red", (0.7, 0.1, 0.07), (0.95, 0.16, 0.08), -0.35, 0.62, 0.45),
    )
    for name, base, color, x, y, radius in lanterns:
        paper = g.paper(name, base, 0.6, color)
        g.node(name, mesh=g.sphere(name, radius, paper), translation=(x, y, 0.0))
        lamp = (x, y - 0.3 * radius, 0.0)
        g.point_light(f"{name} lamp", lamp, color=(1.0, 0.9, 0.75), intensity=5.0 * radius**2, classic=False)
    green = g.paper("leaf", (0.1, 0.28, 0.06), 0.55, (0.5, 0.85, 0.12))
    leaf = g.mesh("leaf", _leaf(1.3, 0.6, 0.25), green)
    for i, (x, y, turn, tilt) in enumerate(((0.7, 0.5, 20.0, 65.0), (1.3, 0.75, -15.0, 100.0), (1.75, 0.35, 5.0, 40.0))):
        stem = g.node(f"stem {i}", translation=(x, y, 0.3), rotation=quaternion_about((0.0, 0.0, 1.0), tilt))
        g.node(f"leaf {i}", parent=stem, mesh=leaf, rotation=quaternion_about((1.0, 0.0, 0.0), 90.0 + turn))
    # A stick between the sun and a leaf. Its shadow is visible through the leaf.
    stick = g.cylinder("stick", 1.6, 0.03, g.metallic_roughness("stick", (0.2, 0.12, 0.06), 0.0, 0.8))
    g.node("stick", mesh=stick, translation=(1.05, 1.0, -0.15), rotation=axis_rotation((0.5, 1.0, 0.0)))
    for i, thickness in enumerate((150.0, 300.0, 450.0, 600.0)):
        pearl = g.filmed(f"film {thickness:.0f} nm", (0.5, 0.5, 0.52), 1.0, thickness, ior=1.8, roughness=0.25)
        g.node(f"pearl {i}", mesh=g.sphere(f"pearl {i}", 0.2, pearl), translation=(-1.6 + 0.5 * i, 0.2, 1.1))
    oil = g.filmed("oil", (0.02, 0.02, 0.02), 0.0, 320.0, ior=1.6)
    g.node("bead", mesh=g.sphere("bead", 0.2, oil), translation=(0.4, 0.2, 1.1))
    lids = (("brushed outwards", (0.75, 0.75, 0.77), 0.0), ("brushed round", (0.9, 0.6, 0.35), 0.5 * math.pi))
    for i, (name, color, rotation) in enumerate(lids):
        metal = g.brushed(name, color, 0.25, 0.8, rotation)
        lid = g.mesh(name, _lid(0.42, 0.12, 6, 32), metal)
        rotation = quaternion_about((1.0, 0.0, 0.0), 25.0)
        g.node(name, mesh=lid, translation=(1.05 + 0.95 * i, 0.2, 1.1), rotation=rotation)
    g.camera("camera", (0.1, 1.7, 6.0), (0.1, 0.75, 0.0), yfov_deg=30.0)
    return g


def all_primitives():
    """Every primitive and every term of the shading formula that POV-Ray has too."""
    g = Gltf()
    g.sky((0.2, 0.3, 0.45), (0.2, 0.22, 0.25))
    floor = g.material("floor", (0.42, 0.4, 0.36), specular=0.1, shininess=20.0, reflection=0.15)
    g.node("floor", mesh=g.plane("floor", floor))
    mirror = g.material(
        "mirror", (0.1, 0.1, 0.1), specular=0.5, shininess=200.0, reflection=(0.7, 0.65, 0.6), ambient=0.05
    )
    g.node("sphere", mesh=g.sphere("sphere", 0.8, mirror), translation=(-1.7, 0.8, -0.6))
    g.node(
        "sunk sphere", mesh=g.sphere("sunk sphere", 0.4, _glossy(g, "sunk sphere", PLUM)), translation=(-0.4, 0.2, 1.3)
    )
    cylinder = g.cylinder("cylinder", 1.4, 0.35, _glossy(g, "cylinder", TEAL))
    g.node("cylinder", mesh=cylinder, translation=(0.1, 0.85, -0.9), rotation=axis_rotation((0.3, 1.0, 0.15)))
    cone = g.cone("cone", 1.3, 0.5, g.material("cone", AMBER, specular=0.3, shininess=8.0, reflection=0.1))
    g.node("cone", mesh=cone, translation=(1.3, 0.65, 0.3))
    frustum = g.frustum("frustum", 0.7, 0.5, 0.25, _glossy(g, "frustum", CORAL))
    g.node("frustum", mesh=frustum, translation=(2.4, 0.35, -0.8))
    glow = g.material("star", AZURE, specular=0.2, shininess=15.0, emissive=(0.05, 0.02, 0.0))
    star = g.mesh("star", meshes.stellated(meshes.icosahedron(0.32), 0.35), glow)
    g.node(
        "star",
        mesh=star,
        translation=(0.5, 0.55, 1.5),
        rotation=quaternion_about((0.3, 1.0, 0.2), 40.0),
        scale=(1.0, 1.1, 0.9),
    )
    wall = g.mesh("mirror wall", meshes.box(5.0, 2.2, 0.1), mirror)
    g.node("mirror wall", mesh=wall, translation=(0.3, 1.1, -2.6), rotation=quaternion_about((0.0, 1.0, 0.0), -12.0))
    g.point_light("warm", (-3.0, 5.0, 4.0), color=(0.5, 0.42, 0.3))
    g.point_light("cool", (4.0, 3.0, 3.0), color=(0.15, 0.22, 0.35))
    g.directional_light("sun", (0.4, -1.0, -0.7), color=(0.3, 0.3, 0.28))
    g.camera("camera", (0.4, 2.6, 6.4), (0.2, 0.6, -0.2), aspect_ratio=1.0, yfov_deg=42.0)
    return g


SCENES = (
    sphere,
    plane,
    cylinder,
    cone,
    box,
    capsule,
    triangles_sharp,
    triangles_smooth,
    strip_and_fan,
    vertex_colors,
    light_point,
    light_directional,
    light_spot,
    light_physical,
    ambient_and_background,
    shadows,
    mirrors,
    emissive,
    orthographic,
    cameras,
    metallic_roughness,
    glass,
    rare_materials,
    all_primitives,
)
