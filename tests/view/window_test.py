#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests promin-view as a user sees it: a real window on an X server, with keys and pointer from xdotool.

window_test.py TEST BIN SCENES: TEST is a function below, BIN the folder of the programs.
"""

import base64
import json
import math
import os
import pathlib
import re
import shlex
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

from display import Display, Failure, Typist, Viewer, wait_for

SIZE = (160, 96)


def expect(condition, what):
    if not condition:
        raise Failure(what)


def run(*words, environment=None):
    return subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=60, env=environment)


class Session:
    """Runs a window on a scene, which is the first of its files, in a folder with a copy of them."""

    SHOWCASE = ("showcase.gltf", "showcase.bin")
    # The kernels of this scene compile in a third of the showcase's time.
    SMALL = ("light_point.gltf",)

    def __init__(self, bin_folder, scenes, folder, *arguments, files=SHOWCASE, takes_keys=True, **environment):
        self.bin = bin_folder
        self.folder = folder
        for name in files:
            shutil.copy(scenes / name, folder)
        self.scene = folder / files[0]
        self.display = Display()
        try:
            words = [files[0], "--size", *map(str, SIZE), "--target-ms", "40", *arguments]
            self.viewer = Viewer(self.display, bin_folder / "promin-view", words, folder, **environment)
            # A replay does not need keys, and may end before the test finds the window.
            if takes_keys and "--replay" not in arguments:
                self.viewer.focus()
        except BaseException:
            self.display.close()
            raise

    def __enter__(self):
        return self.viewer

    def __exit__(self, *_):
        self.viewer.close()
        self.display.close()

    def print_command(self):
        """Presses C and returns the command that it prints."""
        count = self.viewer.out.count("\n")
        self.viewer.press("c")
        wait_for(lambda: self.viewer.out.count("\n") > count, "command")
        return self.viewer.out.splitlines()[-1]

    def take_screenshot(self, number):
        self.viewer.press("F12")
        self.viewer.wait_for_line(f"wrote promin-{number:04}.exr", 1, "screenshot")

    def render(self, command, output):
        """Runs a command as it was printed, but with another output file."""
        words = shlex.split(command)
        expect(words[:2] == ["promin", "render"], f"not a command of promin: {command}")
        words[words.index("-o") + 1] = output
        done = subprocess.run(
            [self.bin / "promin", *words[1:]], cwd=self.folder, capture_output=True, text=True, timeout=60
        )
        expect(done.returncode == 0, f"{command}: {done.stderr}")
        return self.folder / output

    def find_middle(self, command):
        """Returns the target point of a command's camera."""
        return self.find_point(command, (1, 1), (0, 0))

    def find_point(self, command, size, pixel):
        """Returns the point at a pixel of a command's picture, as if the picture had this size."""
        words = shlex.split(command)[1:]
        words[words.index("--size") + 1 : words.index("--size") + 3] = map(str, size)
        place = words.index("-o")
        words[place : place + 2] = ["--explain", *map(str, pixel)]
        words[words.index("--spp") + 1] = "1"
        words[words.index(self.scene.name)] = self.scene
        done = run(self.bin / "promin", *words)
        expect(done.returncode == 0, done.stderr)
        return json.loads(done.stdout)["samples"][0]["rays"][0]["hit"]["position"]

    def expect_same_picture(self, number, command):
        """Expects that the screenshot equals the picture that the command renders."""
        png = self.render(command, "view.png")
        expect(
            png.read_bytes() == (self.folder / f"promin-{number:04}.png").read_bytes(),
            f"the PNG is not what this renders: {command}",
        )
        exr = self.render(command, "view.exr")
        done = run(self.bin / "promin", "compare", self.folder / f"promin-{number:04}.exr", exr, "--fail", 0, "--json")
        expect(done.returncode == 0, done.stderr)
        expect(json.loads(done.stdout)["largest"] == 0, f"the EXR differs: {done.stdout}")

    def expect_shown(self, number, words):
        """Expects that the next screenshot, with this number, equals the picture of the printed command, which has
        these words."""
        self.take_screenshot(number)
        command = self.print_command()
        expect(words in command, f"not what is shown: {command}")
        self.expect_same_picture(number, command)
        return command

    def quit(self):
        # The program may end before the test checks whether it is still running.
        self.viewer.xdotool("key", "Escape")
        code = self.viewer.wait_for_end()
        expect(code == 0, f"it ended with {code}:\n{self.viewer.err}")
        expect("validation" not in self.viewer.err, self.viewer.err)


def eye_of(command):
    return re.search(r"--eye (\S+) (\S+) (\S+)", command).groups()


def time_of(command):
    return re.search(r"--time (\S+)", command).group(1)


def look_of(command):
    return re.search(r"--direction (\S+) (\S+) (\S+)", command).groups()


def flies_and_renders_what_it_shows(bin_folder, scenes, folder):
    session = Session(bin_folder, scenes, folder, files=Session.SMALL, PROMIN_VALIDATION="core")
    with session as viewer:
        viewer.press("Tab")  # the overlay covers so small a window, and would catch the pointer
        session.take_screenshot(1)
        start = session.print_command()
        viewer.press("p")
        viewer.hold("w", 0.3)
        viewer.hold("z", 0.1)
        session.take_screenshot(2)
        flown = session.print_command()
        expect(eye_of(flown) != eye_of(start), f"the camera did not move: {flown}")
        session.expect_same_picture(2, flown)

        viewer.drag((100, 50), (120, 40))
        wait_for(lambda: look_of(session.print_command()) != look_of(flown), "turn of the camera")
        session.expect_same_picture(2, flown)

        viewer.press("r")
        session.take_screenshot(3)
        reset = session.print_command()
        expect(eye_of(reset) == eye_of(start), f"the camera was not reset: {reset}")

        # The camera orbits the point in the middle of the picture. The point stays there, and the camera does not turn
        # towards it first.
        middle = session.find_middle(reset)
        viewer.press("o")
        wait_for(lambda: viewer.hold("d", 0.05) or look_of(session.print_command()) != look_of(reset), "orbit")
        orbited = session.print_command()
        eye, look = eye_of(orbited), look_of(orbited)
        way = [float(m) - float(e) for m, e in zip(middle, eye)]
        ahead = sum(w * float(l) for w, l in zip(way, look))
        beside = math.dist(way, [ahead * float(l) for l in look])
        expect(ahead > 0 and beside < 1e-3 * ahead, f"the orbit left {middle} by {beside}")
        viewer.press("o", "period", "b", "h", "Tab")
        session.take_screenshot(4)
        session.expect_same_picture(4, session.print_command())
        session.quit()


def shows_what_is_chosen(bin_folder, scenes, folder):
    session = Session(
        bin_folder,
        scenes,
        folder,
        "-v",
        *("--no-shadows", "--lights-off", "1,3", "--max-depth", "1"),
        PROMIN_VALIDATION="sync",
    )
    with session as viewer:
        viewer.press("Tab", "p")
        session.expect_shown(1, " --max-depth 1 --no-shadows --lights-off 1,3 ")

        def has_shadows_soon():
            try:
                return wait_for(lambda: " --no-shadows" not in session.print_command(), "shadows", 60.0)
            except Failure:
                return False

        # The overlay's first switch is for shadows; the traced picture changes with it.
        size = f"--size {SIZE[0]} {SIZE[1]}"
        viewer.press("Tab")
        viewer.xdotool("windowsize", "--sync", viewer.window, 300, 270)
        wait_for(lambda: "--size 300 270" in session.print_command(), "new size")
        # The position of the switch depends on the number of lines of the message about the screenshot.
        for y in (137, 120, 154, 103):
            viewer.xdotool("mousemove", "--window", viewer.window, 28, y, "sleep", 0.2, "click", 1)
            if has_shadows_soon():
                break
        viewer.xdotool("windowsize", "--sync", viewer.window, *SIZE, "mousemove", "--window", viewer.window, 150, 5)
        viewer.press("Tab")
        wait_for(lambda: size in session.print_command(), "old size")
        session.take_screenshot(2)
        command = session.print_command()
        expect(" --no-shadows" not in command, "no click in the overlay turned the shadows on")
        session.expect_same_picture(2, command)

        viewer.press("F7")
        command = session.expect_shown(3, " --shading steps ")

        # A click explains a pixel, with the scene's numbers of lights, and moves nothing.
        viewer.xdotool("mousemove", "--window", viewer.window, 140, 90, "click", 1)
        viewer.wait_for_line("pixel 140 90: ", 1, "explanation")
        lights = set(re.findall(r"\blight (\d)", viewer.err))
        expect(re.search(r"^promin-view: (?:  )+camera ray from ", viewer.err, re.M), "the explanation has no lines")
        expect("2" in lights and not lights & {"1", "3"}, f"lights 1 and 3 are off, these are explained: {lights}")
        viewer.press("F1")
        wait_for(lambda: " --shading " not in session.print_command(), "light")
        session.take_screenshot(4)
        after = session.print_command()
        expect(look_of(after) == look_of(command), f"the camera turned: {after}")
        session.expect_same_picture(4, after)
        session.quit()


def lights_as_render_does(bin_folder, scenes, folder):
    """Uses a scene without lights and cameras."""
    files = ("obj_materials.obj", "obj_materials.mtl")
    session = Session(bin_folder, scenes, folder, files=files)
    with session as viewer:
        viewer.wait_for_line("note: assumed: .*three quarters, .*studio, .*grey.*neutral$", 1, "assumptions")
        viewer.press("Tab", "p")
        session.take_screenshot(1)
        command = session.print_command()
        session.expect_same_picture(1, command)

        # A debug view has no exposure.
        viewer.press("F2")
        session.expect_shown(2, " --shading normals ")
        session.quit()

    words = ["--light", "headlight", "--background", "environment", "--exposure", "1.25", "--tone-mapping", "aces"]
    errors = ("--target-error", "0.0625", "--error-in", "display")
    session = Session(bin_folder, scenes, folder, *words, *errors, files=files)
    with session as viewer:
        viewer.press("Tab", "p")
        command = session.expect_shown(3, " ".join(words))
        # After the scene is read again, its light and display are the same as before.
        text = session.scene.read_text()
        session.scene.write_text(text + "# changed\n")
        viewer.wait_for_line("note: read obj_materials.obj", 1, "scene again")
        session.take_screenshot(4)
        session.expect_same_picture(4, command)
        # At rest, the picture is refined to an error of the displayed values.
        viewer.press("p")
        wait_for(lambda: " --target-error 0.0625 " in session.print_command(), "a refined picture")
        session.take_screenshot(5)
        command = session.print_command()
        expect(" --error-in display " in command, f"not what is shown: {command}")
        expect("promin-0005.png, 160x96, error 0.0625 as shown\n" in viewer.err, viewer.err)
        session.expect_same_picture(5, command)
        session.quit()
    pictures = [(folder / f"promin-000{number}.png").read_bytes() for number in (1, 2, 3, 4)]
    expect(len(set(pictures)) == 3 and pictures[2] == pictures[3], "options change nothing, or reading does")


def plays_what_it_recorded(bin_folder, scenes, folder):
    session = Session(bin_folder, scenes, folder, "--record", "flight.json")
    with session as viewer:
        # During a pause, a screenshot has one sample per pixel, like the picture of `promin render` below.
        viewer.press("p")
        session.take_screenshot(1)
        viewer.hold("w", 0.2)
        time.sleep(1.0)
        viewer.hold("w", 0.2)
        session.take_screenshot(2)
        session.quit()
    flight = json.loads((folder / "flight.json").read_text())
    path = flight["frames"]
    expect(len(path) > 2, f"the flight has {len(path)} frames")
    rests = [b["time_s"] - a["time_s"] for a, b in zip(path, path[1:]) if a["eye"] == b["eye"]]
    expect(sum(rest > 0.8 for rest in rests[1:]) > 0, f"a rest of a second became {rests}")

    words = ["--replay", "flight.json", "--fps", "stored"]
    session = Session(bin_folder, scenes, folder, *words, PROMIN_VALIDATION="core")
    with session as viewer:
        code = viewer.wait_for_end()
        expect(code == 0, f"the replay ended with {code}: {viewer.err}")
        expect(
            re.fullmatch(rf"{len(path)} frames: median [\d.]+ ms, 99th percentile [\d.]+ ms, .*\n", viewer.out),
            f"{len(path)} frames were recorded, and replayed: {viewer.out}",
        )

    # The flight at its stored times takes its real time.
    begin = time.monotonic()
    session = Session(bin_folder, scenes, folder, "--replay", "flight.json", "--fps", "10")
    with session as viewer:
        code = viewer.wait_for_end()
    seconds = path[-1]["time_s"]
    expect(code == 0 and time.monotonic() - begin >= seconds - 0.1, f"{seconds} s went by too fast")
    count = math.floor(seconds * 10 + 1e-6) + 1
    expect(viewer.out.startswith(f"{count} frames: "), f"{count} frames are due: {viewer.out}")

    # Between frames, window and renderer use the same cameras.
    half_way = {**flight, "fps": 7, "frames": [{**path[0], "time_s": 0}, {**path[-1], "time_s": 0.2}]}
    (folder / "half_way.json").write_text(json.dumps(half_way))
    session = Session(bin_folder, scenes, folder, "--replay", "half_way.json", "--keep-open")
    with session as viewer:
        viewer.wait_for_line("^2 frames: ", 0, "end of the replay")
        viewer.focus()
        viewer.press("p")
        session.take_screenshot(3)
        command = f"promin render {session.scene.name} --path half_way.json --frames 1 --size {SIZE[0]} {SIZE[1]} --spp 1 -o x"
        session.expect_same_picture(3, command)
        session.quit()

    # The flight ends where the last screenshot was taken.
    last = math.floor(seconds * flight["fps"] + 1e-6)
    words = ["--size", *SIZE, "--spp", "1", "--path", folder / "flight.json", "--frames", f"{last}-{last}", "--quiet"]
    done = run(bin_folder / "promin", "render", session.scene, *words, "-o", folder / "last.png")
    expect(done.returncode == 0, done.stderr)
    expect(
        (folder / "last.png").read_bytes() == (folder / "promin-0002.png").read_bytes(),
        "the flight does not end where the camera did",
    )


def write_moving(file):
    """Writes a scene with a light whose triangle moves to the right and back in two seconds."""
    times, places = (0.0, 1.0, 2.0), ((0, 0, 0), (1, 0, 0), (0, 0, 0))
    corners = ((-1, -1, 0), (1, -1, 0), (0, 1, 0))
    data = struct.pack("<9f3f9f", *sum(corners, ()), *times, *sum(places, ()))
    view = lambda start, size: {"buffer": 0, "byteOffset": start, "byteLength": size}
    numbers = lambda view, kind, **more: {"bufferView": view, "componentType": 5126, "count": 3, "type": kind, **more}
    lights = "KHR_lights_punctual"
    document = {
        "asset": {"version": "2.0"},
        "extensionsUsed": [lights],
        "extensions": {lights: {"lights": [{"type": "directional", "intensity": 3}]}},
        "buffers": [{"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()}],
        "bufferViews": [view(0, 36), view(36, 12), view(48, 36)],
        "accessors": [
            numbers(0, "VEC3", min=[-1, -1, 0], max=[1, 1, 0]),
            numbers(1, "SCALAR", min=[0], max=[2]),
            numbers(2, "VEC3"),
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}, {"extensions": {lights: {"light": 0}}}],
        "scenes": [{"nodes": [0, 1]}],
        "scene": 0,
        "animations": [
            {
                "name": "slide",
                "samplers": [{"input": 1, "output": 2}],
                "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
            }
        ],
    }
    file.write_text(json.dumps(document))


def play(session, count):
    """Plays the animation until the window has shown this number of poses. Returns the numbers that it reports at the
    end: the poses, and how many of them used a scene again."""
    times = set()

    def has_shown():
        command = session.print_command()
        if " --time " in command:
            times.add(time_of(command))
        return len(times) >= count

    session.viewer.press("space")
    wait_for(has_shown, f"{count} poses")
    session.viewer.press("space")
    line = session.viewer.wait_for_line(r"played \d+ poses", 1, "report of the animation")
    poses, reused = re.search(r"played (\d+) poses in \S+ s, (\d+) of them", line).groups()
    expect(int(poses) >= count, f"{count} poses were seen, but: {line}")
    return int(poses), int(reused)


def plays_an_animation(bin_folder, scenes, folder):
    write_moving(folder / "moving.gltf")
    work = folder / "work"
    work.mkdir()
    session = Session(bin_folder, folder, work, "-v", files=("moving.gltf",), PROMIN_VALIDATION="core")
    with session as viewer:
        viewer.press("Tab")
        viewer.wait_for_line("shown: a picture", 1, "picture")
        expect("--time" not in session.print_command(), "it does not begin with the pose of the nodes")
        viewer.press("p")  # without refinement, a screenshot and the command after it have the same samples
        play(session, 2)
        stopped = session.expect_shown(1, "--animation 'slide'")
        viewer.press("Right")
        wait_for(lambda: time_of(session.print_command()) != time_of(stopped), "step")
        session.expect_shown(2, "--animation 'slide'")
        viewer.press("n")
        wait_for(lambda: "--time 0 " in session.print_command(), "start of the animation")
        session.expect_shown(3, "--animation 'slide'")
        session.quit()


def moves_instances(bin_folder, scenes, folder):
    write_moving(folder / "moving.gltf")
    work = folder / "work"
    work.mkdir()
    session = Session(bin_folder, folder, work, "-v", "--instances", "all", files=("moving.gltf",))
    with session as viewer:
        viewer.press("Tab")
        viewer.wait_for_line("shown: a picture", 1, "picture")
        viewer.press("p")
        # The first poses get new scenes, up to three.
        poses, reused = play(session, 8)
        expect(reused > 0, f"none of {poses} poses used a scene again")
        stopped = session.expect_shown(1, "--instances all")
        viewer.press("Right")
        wait_for(lambda: time_of(session.print_command()) != time_of(stopped), "step")
        session.expect_shown(2, "--instances all")
        session.quit()


def stops_at_a_signal(bin_folder, scenes, folder):
    session = Session(bin_folder, scenes, folder, "--record", "flight.json", files=Session.SMALL)
    with session as viewer:
        session.take_screenshot(1)
        viewer.hold("w", 0.2)
        viewer.press("F12")
        viewer.process.terminate()
        code = viewer.wait_for_end()
        expect(code == -signal.SIGTERM, f"it ended with {code}: {viewer.err}")
    frames = json.loads((folder / "flight.json").read_text())["frames"]
    expect(frames[0]["eye"] != frames[-1]["eye"], f"the flight was lost: {frames}")
    names = sorted(file.name for file in folder.iterdir() if file.name != session.scene.name)
    pairs = [f"promin-{number:04}.{ending}" for number in (1, 2) for ending in ("exr", "png")]
    expect(names in (["flight.json", *pairs[:2]], ["flight.json", *pairs]), f"files are left half written: {names}")

    # No option of `promin render` takes the height of an orthographic camera's view.
    flight = {"format": "promin camera path", "version": 1, "frames": [{**frames[0], "ymag": 2.5}]}
    del flight["frames"][0]["fov_deg"]
    (folder / "flight.json").write_text(json.dumps(flight))
    session = Session(bin_folder, scenes, folder, "--replay", "flight.json", "--keep-open", files=Session.SMALL)
    with session as viewer:
        viewer.wait_for_line("^1 frames: ", 0, "end of the replay")
        viewer.focus()
        viewer.press("c")
        viewer.wait_for_line("warning: no command of promin render .* 2.5 ", 1, "refusal")
        expect("promin render" not in viewer.out, viewer.out)
        session.quit()


def survives_its_window(bin_folder, scenes, folder):
    session = Session(bin_folder, scenes, folder, files=Session.SMALL, PROMIN_VALIDATION="sync")
    with session as viewer:
        session.take_screenshot(1)
        for i in range(20):
            viewer.xdotool("windowsize", viewer.window, SIZE[0] + 37 * (i % 5) - 60, SIZE[1] + 23 * (i % 7) - 40)
            viewer.hold("w" if i % 2 else "s", 0.02)
            viewer.check_alive()
        # A minimised window has no pixels and traces none, although a key is pressed and a picture could be refined.
        viewer.xdotool("keydown", "w")
        viewer.minimise(True)
        wait_for(lambda: viewer.processor_share(0.5) < 0.1, "rest of a minimised window", 30.0)
        viewer.minimise(False)
        viewer.xdotool("keyup", "w")
        viewer.xdotool("windowsize", "--sync", viewer.window, 120, 70)
        viewer.xdotool("windowfocus", "--sync", viewer.window)
        wait_for(lambda: "--size 120 70" in session.print_command(), "new size")
        viewer.press("p")
        session.take_screenshot(2)
        session.expect_same_picture(2, session.print_command())
        session.quit()


def quits_while_it_compiles(bin_folder, scenes, folder):
    """Starts with an empty driver cache; the first time it acts as soon as there is a window."""
    for awaited in (None, "loaded showcase"):
        session = Session(bin_folder, scenes, folder, "-v", MESA_SHADER_CACHE_DIR=str(folder / "no cache"))
        with session as viewer:
            if awaited:
                viewer.wait_for_line(awaited, 1, "scene")
            session.quit()
            expect("no input waited longer than" in viewer.err, f"it did not end as it should: {viewer.err}")


def answers_while_it_works(bin_folder, scenes, folder):
    """Presses a key every 20 ms while the window loads, compiles, refines and explains with an empty driver cache."""
    session = Session(bin_folder, scenes, folder, "-v", MESA_SHADER_CACHE_DIR=str(folder / "no cache"))
    with session as viewer:
        viewer.press("Tab")  # the panel would catch the click
        typed = {}
        with Typist(viewer.display) as typist:
            for pattern, stage in (
                ("shown: a draft", "draft"),
                ("shown: a picture", "picture"),
                ("shown: a refined", "refined picture"),
                ("explained: ", "explanation"),
            ):
                if stage == "explanation":
                    viewer.xdotool("mousemove", "--window", viewer.window, 100, 60, "click", 1)
                line = viewer.wait_for_line(pattern, 1, stage)
                typed[stage] = (typist.count, int(re.search(r"(\d+) keys? pressed", line).group(1)))
        session.quit()
        worst = re.search(r"no input waited longer than (\d+) ms, for work of at most (\d+) ms; (\d+) keys", viewer.err)
    # Tab and Esc also count as keys. The test does not wait for the last key.
    expect(int(worst.group(3)) >= typist.count + 1, f"{typist.count} keys were typed: {worst.group(0)}")
    stages = [(0, 0), *typed.values()]
    for stage, (typed_before, answered_before), (typed_then, answered_then) in zip(typed, stages, stages[1:]):
        # If the window does not respond during a stage, it handles most keys after the stage. Short stages prove
        # nothing, because the test may check late.
        count = typed_then - typed_before
        answered = answered_then - answered_before
        expect(count < 100 or 2 * answered >= count, f"few keys were answered before the {stage}: {typed}")
    print(f"{worst.group(0)}; typed and answered: {typed}")


def looks_from_where_keys_say(bin_folder, scenes, folder):
    session = Session(bin_folder, scenes, folder, files=("box.gltf",))
    with session as viewer:
        viewer.press("Tab", "p")
        command = session.print_command()
        eyes = {}
        for key, look in (("1", (0, 0, -1)), ("3", (-1, 0, 0)), ("7", (0, -1, 0))):
            viewer.press(key)
            wait_for(lambda: math.dist(map(float, look_of(session.print_command())), look) < 1e-5, f"view of {key}", 60)
            eyes[key] = [float(x) for x in eye_of(session.print_command())]
        # F keeps the direction and frames the model again.
        viewer.xdotool("mousemove", "--window", viewer.window, 80, 48, "click", 4, "click", 4, "click", 4)

        def distance():
            return math.dist(map(float, eye_of(session.print_command())), eyes["7"])

        height = math.dist(eyes["7"], (0, 0, 0))
        wait_for(lambda: distance() > 0.1 * height, "nearer camera", 60)
        viewer.press("f")
        wait_for(lambda: distance() < 1e-3 * height, "framed model", 60)
        expect(math.dist(map(float, look_of(session.print_command())), (0, -1, 0)) < 1e-5, "F turned the camera")

        # A double click turns the camera to the point that was under the pointer.
        viewer.press("r")
        wait_for(lambda: eye_of(session.print_command()) == eye_of(command), "reset camera", 60)
        place = (95, 50)
        point = session.find_point(command, SIZE, place)
        viewer.xdotool("mousemove", "--window", viewer.window, *place, "click", 1, "click", 1)
        wait_for(lambda: look_of(session.print_command()) != look_of(command), "turn to a point", 60)
        middle = session.find_point(session.print_command(), (1, 1), (0, 0))
        expect(math.dist(point, middle) < 0.02 * math.dist(point, map(float, eye_of(command))), f"{middle}, not {point}")

        # These lines test full screen and back.
        viewer.press("F11")
        width, height = viewer.display.size
        wait_for(lambda: f"--size {width} {height} " in session.print_command(), "full screen", 60)
        viewer.press("F11")
        wait_for(lambda: "--size {} {} ".format(*SIZE) in session.print_command(), "window", 60)
        session.quit()


def opens_and_saves_by_dialog(bin_folder, scenes, folder):
    """Opens and saves files through a replacement for the desktop's dialog, which returns fixed names."""
    programs = folder / "programs"
    programs.mkdir()
    shutil.copy(scenes / "box.gltf", folder / "another.gltf")
    zenity = programs / "zenity"
    zenity.write_text(f'#!/bin/sh\ncase "$*" in\n*--save*) echo "{folder}/a box.png" ;;\n*) echo "{folder}/another.gltf" ;;\nesac\n')
    zenity.chmod(0o755)
    session = Session(bin_folder, scenes, folder, "-v", files=("sphere.gltf",), PATH=str(programs))
    with session as viewer:
        viewer.xdotool("windowsize", "--sync", viewer.window, 340, 300)
        wait_for(lambda: "sphere.gltf" in session.print_command() and "340 300" in session.print_command(), "picture")

        # A pen has no position before it touches the panel.
        move = ("mousemove", "--window", viewer.window)
        viewer.xdotool(*move, 320, 280, "sleep", 0.5, *move, 150, 20, "click", 1, "sleep", 1)

        def click_until(x, has_effect, what):
            """Finds the buttons, which are below some lines of text."""
            for y in [*range(50, 110, 8)] * 3:
                viewer.xdotool("mousemove", "--window", viewer.window, x, y, "sleep", 0.2, "click", 1, "sleep", 0.5)
                if has_effect():
                    return
            raise Failure(f"no click has {what}")

        click_until(40, lambda: viewer.run_xdotool("search", "--name", "^another.gltf - promin$").stdout, "opened")
        wait_for(lambda: "another.gltf" in session.print_command(), "other scene")
        viewer.press("p")
        click_until(100, lambda: "wrote " in viewer.err, "saved")
        line = viewer.wait_for_line("wrote .*a box.png", 1, "saved picture")
        again = session.render(line[line.index("promin render ") :], "again.png")
        expect(again.read_bytes() == (folder / "a box.png").read_bytes(), f"the command gives another picture: {line}")
        expect("explained: " not in viewer.err, "a click on the panel went through it")
        session.quit()


def opens_what_is_dropped(bin_folder, scenes, folder):
    box = folder / "a box.gltf"
    shutil.copy(scenes / "box.gltf", box)
    session = Session(bin_folder, scenes, folder, files=("sphere.gltf",))
    with session as viewer:
        viewer.press("Tab", "p")
        expect("sphere.gltf" in session.print_command(), "another scene than the first")
        viewer.drop(box)
        wait_for(lambda: viewer.run_xdotool("search", "--name", "^a box.gltf - promin$").stdout, "title", 60)
        wait_for(lambda: box.name in session.print_command(), "dropped scene", 60)
        session.expect_shown(1, f"'{box}'")

        # The message names a file that is not a scene, and the picture stays.
        text = folder / "words.txt"
        text.write_text("not a scene")
        viewer.drop(text)
        viewer.wait_for_line("warning: .*words.txt", 1, "sentence")
        session.expect_shown(2, f"'{box}'")
        session.quit()


def turns_the_light(bin_folder, scenes, folder):
    session = Session(bin_folder, scenes, folder, "--light-rotation", "10", files=("ply_faces.ply", "ply_checker.png"))
    with session as viewer:
        viewer.press("Tab", "p")
        command = session.expect_shown(1, " --light-rotation 10 ")
        viewer.xdotool("keydown", "shift")
        viewer.drag((40, 50), (120, 50))
        viewer.xdotool("keyup", "shift")
        # The pointer moves 80 pixels in a window with a height of 96.
        wait_for(lambda: " --light-rotation 160 " in session.print_command(), "turned light", 60)
        session.take_screenshot(2)
        turned = session.print_command()
        expect(eye_of(turned) == eye_of(command), f"the camera moved: {turned}")
        session.expect_same_picture(2, turned)
        pictures = [(folder / f"promin-000{number}.png").read_bytes() for number in (1, 2)]
        expect(pictures[0] != pictures[1], "the light was not turned")
        # This click explains a pixel while the light is rotated.
        viewer.xdotool("mousemove", "--window", viewer.window, 80, 50, "click", 1)
        session.quit()


def reads_a_changed_scene(bin_folder, scenes, folder):
    session = Session(bin_folder, scenes, folder, PROMIN_VALIDATION="sync")
    with session as viewer:
        text = session.scene.read_text()
        viewer.press("p")
        viewer.hold("w", 0.1)
        session.take_screenshot(1)
        before = session.print_command()

        session.scene.write_text(text[: len(text) // 2])
        viewer.wait_for_line("warning: .*showcase.gltf", 1, "failure of a broken scene")
        session.take_screenshot(2)
        expect(
            (folder / "promin-0001.png").read_bytes() == (folder / "promin-0002.png").read_bytes(),
            "a broken scene changed the picture",
        )

        changed = text.replace('"color": [0.1, 0.17, 0.22]', '"color": [0.9, 0.1, 0.1]')
        expect(changed != text, "the showcase has another background now: change this test")
        session.scene.write_text(changed)
        viewer.wait_for_line("note: read showcase.gltf", 1, "new scene")
        session.take_screenshot(3)
        after = session.print_command()
        expect(after == before, f"the camera moved: {after}")
        expect(
            (folder / "promin-0001.png").read_bytes() != (folder / "promin-0003.png").read_bytes(),
            "the new scene is not shown",
        )
        session.expect_same_picture(3, after)

        # The window watches the files beside the scene, too, and shows the loader's warnings.
        warned = changed.replace('"type": "plain"', '"type": "gradient"')
        expect(warned != changed, "the showcase has another sky now: change this test")
        session.scene.write_text(warned)
        viewer.wait_for_line("warning: .*sky", 1, "warning")
        binary = session.scene.with_suffix(".bin")
        binary.write_bytes(binary.read_bytes())
        wait_for(lambda: viewer.err.count("note: read showcase.gltf") == 3, "scene with its changed buffer")
        session.quit()


def lights_a_changed_scene(bin_folder, scenes, folder):
    """Adds a strong lamp to a file without light, which then gets less other light."""
    (folder / "room.mtl").write_text("newmtl wall\nKd 0.8 0.8 0.8\nnewmtl lamp\nKd 0 0 0\nKe 12 9 6\n")
    (folder / "room.obj").write_text(
        "mtllib room.mtl\nv -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nv -.5 1 -.5\nv .5 1 -.5\nv .5 1 .5\nv -.5 1 .5\n"
        "v -2 1 -2\nv 2 1 -2\nusemtl wall\nf 4 3 2 1\nf 1 2 10 9\n"
    )
    work = folder / "work"
    work.mkdir()
    session = Session(bin_folder, folder, work, "--integrator", "direct", files=("room.obj", "room.mtl"))
    with session as viewer:
        viewer.press("Tab", "p")
        command = session.expect_shown(1, " --integrator direct ")
        expect(" --light " not in command, f"a light was chosen without a lamp: {command}")
        session.scene.write_text(session.scene.read_text() + "usemtl lamp\nf 5 6 7 8\n")
        viewer.wait_for_line("note: read room.obj", 1, "scene with a lamp")
        session.expect_shown(2, " --light fill ")
        session.quit()


def fails_in_a_sentence(bin_folder, scenes, folder):
    """Simulates a lost device and too little memory, at the start and while the window flies."""
    lost, no_memory = -4, -2
    for call, number, result, sentence in (
        ("vkAllocateMemory", 3, no_memory, "the device has not enough memory ("),
        ("vkQueueSubmit", 12, lost, "the device was lost ("),
    ):
        # The path of layers contains only this layer and no validation layers.
        layer = {"VK_LAYER_PATH": os.environ["PROMIN_TEST_LAYERS"], "VK_INSTANCE_LAYERS": "VK_LAYER_PROMIN_fault"}
        layer["PROMIN_VALIDATION"] = ""
        fault = {"PROMIN_TEST_FAULT": f"{call} {number} {result}"}
        session = Session(bin_folder, scenes, folder, "--record", "flight.json", takes_keys=False, **layer, **fault)
        with session as viewer:
            code = viewer.wait_for_end()
            expect(code == 1, f"{fault} ended with {code}: {viewer.err}")
            errors = [line for line in viewer.err.splitlines() if re.match("promin-view: (?!note|warning)", line)]
            expect(len(errors) == 1 and errors[0].startswith(f"promin-view: {sentence}"), viewer.err)
    # The flight so far is kept.
    expect(json.loads((folder / "flight.json").read_text())["frames"], "the flight was lost")


def only_the_window_links_glfw(bin_folder, *_):
    for program, links_it in (("promin-view", True), ("promin", False)):
        done = run("readelf", "--dynamic", bin_folder / program)
        expect(done.returncode == 0, done.stderr)
        expect(("libglfw" in done.stdout) == links_it, f"{program} links: {done.stdout}")


def needs_a_display(bin_folder, scenes, _):
    # No folder exists in which a display could be found. Neither the driver nor a library may print a message about
    # this.
    missing = ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR")
    environment = {name: value for name, value in os.environ.items() if name not in missing}
    done = run(bin_folder / "promin-view", scenes / "sphere.gltf", environment=environment)
    expect(done.returncode == 4, f"it ended with {done.returncode}: {done.stderr}")
    expect(re.match(r"promin-view: no display.*promin render, which needs no window\n$", done.stderr), done.stderr)


def refuses_what_is_wrong(bin_folder, scenes, folder):
    for code, words in (
        (2, ["--target-ms", "0", scenes / "sphere.gltf"]),
        (2, ["--present-mode", "soon", scenes / "sphere.gltf"]),
        (2, ["--lights-off", "7", scenes / "sphere.gltf"]),
        (2, ["--keep-open", scenes / "sphere.gltf"]),
        (2, ["--fps", "25", scenes / "sphere.gltf"]),
        (2, ["--scale", "2", scenes / "sphere.gltf"]),
        (3, ["--replay", folder / "missing.json", scenes / "sphere.gltf"]),
        (2, []),
        (3, [folder / "missing.gltf"]),
    ):
        done = run(bin_folder / "promin-view", *words)
        expect(done.returncode == code, f"{words}: {done.returncode}, not {code}: {done.stderr}")
        expect(done.stderr.startswith("promin-view: "), done.stderr)
        expect(done.stderr.count("\n") == 1, done.stderr)


def main():
    name, bin_folder, scenes = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix="promin_view_") as folder:
        try:
            globals()[name](pathlib.Path(bin_folder).resolve(), pathlib.Path(scenes).resolve(), pathlib.Path(folder))
        except Failure as failure:
            sys.exit(f"{name}: {failure}")


if __name__ == "__main__":
    main()
