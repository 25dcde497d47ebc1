# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""A window on an X server without a screen, and functions that act as its user."""

import ctypes
import os
import pathlib
import re
import subprocess
import tempfile
import threading
import time


class Failure(Exception):
    """Says what a test found wrong."""


def wait_for(condition, what, seconds=180.0):
    """Calls condition() repeatedly and returns its first true value."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if value := condition():
            return value
        time.sleep(0.02)
    raise Failure(f"no {what} within {seconds:g} s")


class Display:
    """Runs a separate X server with a free display number."""

    def __init__(self, size="1024x768x24"):
        # Another server that ends at this moment may remove this one's socket. Without -noreset a server restarts when
        # its last client goes, and refuses the next client meanwhile.
        self.size = tuple(map(int, size.split("x")[:2]))
        for _ in range(3):
            self._start(size)
            if self._answers():
                return
            self.close()
        raise Failure("Xvfb does not answer")

    def _start(self, size):
        reader, writer = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writer), "-screen", "0", size, "-nolisten", "tcp", "-noreset"],
            pass_fds=[writer],
            stderr=subprocess.DEVNULL,
        )
        os.close(writer)
        with os.fdopen(reader) as pipe:
            number = pipe.readline().strip()
        if not number:
            raise Failure("Xvfb does not start")
        # GLFW first looks for a Wayland compositor, which may exist in the user's own folder.
        self.runtime_folder = tempfile.TemporaryDirectory(prefix="promin_display_")  # of mode 0700, as required
        self.environment = {**os.environ, "DISPLAY": f":{number}", "XDG_RUNTIME_DIR": self.runtime_folder.name}
        self.environment.pop("WAYLAND_DISPLAY", None)

    def _answers(self):
        done = subprocess.run(["xdotool", "getdisplaygeometry"], env=self.environment, capture_output=True)
        return done.returncode == 0

    def close(self):
        self.process.terminate()
        self.process.wait()
        self.runtime_folder.cleanup()


class Client:
    """Holds a connection to a server, with Xlib."""

    def __init__(self, display):
        self.x11 = ctypes.CDLL("libX11.so.6")
        for name in ("XOpenDisplay", "XInternAtom", "XDefaultRootWindow", "XCreateSimpleWindow"):
            getattr(self.x11, name).restype = ctypes.c_void_p
        self.server = ctypes.c_void_p(self.x11.XOpenDisplay(display.environment["DISPLAY"].encode()))

    def atom(self, name):
        return self.x11.XInternAtom(self.server, name.encode(), 0)

    def close(self):
        self.x11.XCloseDisplay(self.server)


class FileManager(Client):
    """Acts as a window from which files are dragged, with version 5 of the protocol XDND."""

    CLIENT_MESSAGE = 33
    SELECTION_REQUEST = 30
    SELECTION_NOTIFY = 31
    VERSION = 5
    # Xlib's events are arrays of words: the type, the serial number, whether it was sent, the connection, and the
    # event's own values.
    Event = ctypes.c_long * 24

    def __init__(self, display):
        super().__init__(display)
        root = ctypes.c_ulong(self.x11.XDefaultRootWindow(self.server))
        black = ctypes.c_ulong(0)
        self.window = self.x11.XCreateSimpleWindow(self.server, root, 0, 0, 1, 1, 0, black, black)
        self.selection = self.atom("XdndSelection")
        self.list_type = self.atom("text/uri-list")

    def drop(self, files, target, place):
        """Drops files at a position of the desktop, on the window at this position."""
        self.x11.XSetSelectionOwner(
            self.server, ctypes.c_ulong(self.selection), ctypes.c_ulong(self.window), ctypes.c_ulong(0)
        )
        self._tell(target, "XdndEnter", self.VERSION << 24, self.list_type)
        self._tell(target, "XdndPosition", 0, place[0] << 16 | place[1], 0, self.atom("XdndActionCopy"))
        status = self._wait_for(self.CLIENT_MESSAGE, "XdndStatus")
        if not status[8] & 1:
            raise Failure("the window takes no files")
        self._tell(target, "XdndDrop")
        request = self._wait_for(self.SELECTION_REQUEST)
        self._hand_over("".join(file.as_uri() + "\r\n" for file in files).encode(), request)
        self._wait_for(self.CLIENT_MESSAGE, "XdndFinished")

    def _send(self, target, words):
        event = self.Event(*words)
        self.x11.XSendEvent(self.server, ctypes.c_ulong(target), 0, ctypes.c_long(0), event)
        self.x11.XFlush(self.server)

    def _tell(self, target, message, *words):
        self._send(target, (self.CLIENT_MESSAGE, 0, 0, 0, target, self.atom(message), 32, self.window, *words))

    def _hand_over(self, content, request):
        requestor, selection, kind, name, time_stamp = request[5:10]
        if (selection, kind) != (self.selection, self.list_type):
            raise Failure("the window asks for something else than the files")
        words = [ctypes.c_ulong(word) for word in (requestor, name, kind)]
        self.x11.XChangeProperty(self.server, *words, 8, 0, content, len(content))
        self._send(requestor, (self.SELECTION_NOTIFY, 0, 0, 0, requestor, selection, kind, name, time_stamp))

    def _wait_for(self, kind, message=None):
        """Returns the next event of a kind, or the next client message with this name; drops other events."""
        event = self.Event()

        def take():
            while self.x11.XPending(self.server):
                self.x11.XNextEvent(self.server, event)
                if event[0] & 0xFFFFFFFF == kind and (message is None or event[5] == self.atom(message)):
                    return list(event)
            return None

        return wait_for(take, message or "request for the files", 60.0)


class Typist(Client):
    """Repeatedly presses keys that have no effect, from the beginning of a block to its end."""

    INTERVAL = 0.02

    # If a key is released and pressed at the same time, GLFW reports that the key repeats.
    KEYS = "jk"

    def __init__(self, display):
        super().__init__(display)
        self.hands = ctypes.CDLL("libXtst.so.6")
        self.codes = [self.x11.XKeysymToKeycode(self.server, ctypes.c_ulong(ord(key))) for key in self.KEYS]
        self.count = 0
        self.has_ended = threading.Event()
        self.thread = threading.Thread(target=self._type)

    def _type(self):
        while not self.has_ended.wait(self.INTERVAL):
            code = self.codes[self.count % len(self.codes)]
            for is_down in (1, 0):
                self.hands.XTestFakeKeyEvent(self.server, code, is_down, ctypes.c_ulong(0))
            self.x11.XFlush(self.server)
            self.count += 1

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.has_ended.set()
        self.thread.join()
        self.close()


class Viewer:
    """Runs promin-view in a folder; its output goes to files."""

    def __init__(self, display, program, arguments, folder, **environment):
        self.display = display
        self.logs = [tempfile.TemporaryFile("w+"), tempfile.TemporaryFile("w+")]
        self.process = subprocess.Popen(
            [program, *arguments],
            cwd=folder,
            env={**display.environment, **environment},
            stdout=self.logs[0],
            stderr=self.logs[1],
        )

    def run_xdotool(self, *words):
        return subprocess.run(
            ["xdotool", *map(str, words)], env=self.display.environment, capture_output=True, text=True, timeout=60
        )

    def xdotool(self, *words):
        done = self.run_xdotool(*words)
        if done.returncode != 0:
            self.check_alive()
            raise Failure(f"xdotool {words}: {done.stderr}")

    def focus(self):
        """Sends keys to the window from now on."""
        self.window = wait_for(self.find_window, "window")
        self.xdotool("windowfocus", "--sync", self.window)

    def find_window(self):
        self.check_alive()
        # The search fails if there is no window yet.
        found = self.run_xdotool("search", "--onlyvisible", "--name", "promin$").stdout.strip()
        return found.split("\n")[0] if found else None

    def minimise(self, is_minimised):
        """Sets the window's state as a window manager does: with the property that describes the state, and by mapping
        the window."""
        states = {True: 3, False: 1}  # IconicState, NormalState of ICCCM 4.1.3.1
        client = Client(self.display)
        state = ctypes.c_ulong(client.atom("WM_STATE"))
        window = ctypes.c_ulong(int(self.window))
        value = (ctypes.c_ulong * 2)(states[is_minimised], 0)
        client.x11.XChangeProperty(client.server, window, state, state, 32, 0, value, 2)
        client.close()
        self.xdotool("windowunmap" if is_minimised else "windowmap", "--sync", self.window)

    def processor_seconds(self):
        """Returns the processor time that the program has used so far."""
        words = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return sum(map(int, words[11:13])) / os.sysconf("SC_CLK_TCK")

    def processor_share(self, seconds):
        """Observes the program for this time. Returns the fraction of one core that the program uses."""
        before, start = self.processor_seconds(), time.monotonic()
        time.sleep(seconds)
        return (self.processor_seconds() - before) / (time.monotonic() - start)

    def read(self, stream):
        # The test needs a separate handle of the file, because the program writes at the position of this handle.
        return pathlib.Path(f"/proc/self/fd/{self.logs[stream].fileno()}").read_text()

    @property
    def out(self):
        return self.read(0)

    @property
    def err(self):
        return self.read(1)

    def check_alive(self):
        if self.process.poll() is not None:
            raise Failure(f"promin-view ended with {self.process.returncode}:\n{self.err}")

    def press(self, *keys):
        self.xdotool("key", *keys)
        self.check_alive()

    def hold(self, key, seconds):
        self.xdotool("keydown", key)
        time.sleep(seconds)
        self.xdotool("keyup", key)

    def drag(self, start, end):
        self.xdotool("mousemove", "--window", self.window, *start, "mousedown", 1)
        self.xdotool("mousemove", "--window", self.window, *end, "mouseup", 1)

    def drop(self, *files):
        """Drops files on the window, as a file manager does."""
        manager = FileManager(self.display)
        manager.drop(files, int(self.window), (10, 10))
        manager.close()

    def wait_for_line(self, pattern, stream, what):
        """Returns the first line that matches the pattern."""

        def search():
            self.check_alive()
            return re.search(rf"^.*{pattern}.*$", self.read(stream), re.MULTILINE)

        return wait_for(search, what).group(0)

    def wait_for_end(self):
        try:
            return self.process.wait(timeout=60)
        except subprocess.TimeoutExpired:
            raise Failure("promin-view does not end") from None

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
