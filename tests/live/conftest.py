"""A browser for tests of the live page: headless Chromium, controlled by its protocol over a pipe."""

import base64
import contextlib
import itertools
import json
import os
import shutil
import subprocess
import sys

import pytest
from opening import opened

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
# the protocol's pipes are file descriptors 3 and 4
_AT_3_AND_4 = """
import fcntl, os, sys
pipes = [fcntl.fcntl(int(pipe), fcntl.F_DUPFD, 10) for pipe in sys.argv[1:3]]
for number, pipe in zip((3, 4), pipes):
    os.dup2(pipe, number)
os.execv(sys.argv[3], sys.argv[3:])
"""


class Browser:
    """One tab. Records logged errors and network requests of the page."""

    def __init__(self, program, profile):
        down, self._to = os.pipe()
        self._from, up = os.pipe()
        command = [
            *(sys.executable, "-c", _AT_3_AND_4, str(down), str(up), program, "--headless", "--no-sandbox"),
            *("--remote-debugging-pipe", f"--user-data-dir={profile}", "--no-first-run", "--disable-extensions"),
            *("--disable-background-networking", "--disable-dev-shm-usage", "--disable-gpu"),
        ]
        with open(profile.parent / "browser.log", "w") as log:
            self._process = subprocess.Popen(command, pass_fds=(down, up), stdout=log, stderr=log)
        os.close(down)
        os.close(up)
        self._ids, self._unread, self._session = itertools.count(1), b"", None
        self.errors, self.asked = [], []

    def attach(self):
        """Open the tab."""
        target = self.send("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.send(f"{domain}.enable")

    def send(self, method, **parameters):
        """Return the result of a command of the protocol."""
        number = next(self._ids)
        message = {"id": number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        return self._until(lambda answer: answer.get("id") == number)["result"]

    def _until(self, wanted):
        while True:
            while b"\0" not in self._unread:
                some = os.read(self._from, 2**20)
                assert some, "the browser has gone"
                self._unread += some
            text, _, self._unread = self._unread.partition(b"\0")
            message = json.loads(text)
            assert "error" not in message, message
            match message.get("method"):
                case "Runtime.exceptionThrown" | "Log.entryAdded":
                    self.errors.append(message["params"])
                case "Network.requestWillBeSent":
                    self.asked.append(message["params"]["request"]["url"])
            if wanted(message):
                return message

    def open(self, path, width=1440, height=900, mobile=False, link=""):
        """Load a file, with ``link`` after the name, in a window of that size; clear recorded errors and requests."""
        self.errors, self.asked = [], []
        self.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)
        for url in (["about:blank"] if link else []) + [path.as_uri() + link]:  # a link alone would not load anew
            self.send("Page.navigate", url=url)
            self._until(lambda message: message.get("method") == "Page.loadEventFired")

    def run(self, script):
        """Return the value of a JavaScript expression."""
        answer = self.send("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def press(self, key, times=1):
        """Press a key."""
        code = {"ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40, "Tab": 9, " ": 32}[key]
        for _ in range(times):
            for way in ("rawKeyDown", "keyUp"):
                self.send("Input.dispatchKeyEvent", type=way, key=key, code=key, windowsVirtualKeyCode=code)

    def drag(self, start, end):
        """Drag the mouse from ``start`` to ``end`` (x and y on the page)."""
        for way, (x, y), buttons in (
            ("mousePressed", start, 1),
            ("mouseMoved", end, 1),
            ("mouseReleased", end, 0),
        ):
            self.send("Input.dispatchMouseEvent", type=way, x=x, y=y, button="left", buttons=buttons, clickCount=1)

    def picture(self, path):
        """Return the whole page as PNG."""
        size = self.send("Page.getLayoutMetrics")["cssContentSize"]
        clip = {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1}
        shot = self.send("Page.captureScreenshot", format="png", clip=clip, captureBeyondViewport=True)
        path.write_bytes(base64.b64decode(shot["data"]))

    def close(self):
        """End the browser."""
        os.close(self._to)
        os.close(self._from)
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    program = next(filter(None, map(shutil.which, BROWSERS)), None)
    if not program:
        pytest.skip(f"no browser: none of {', '.join(BROWSERS)} is installed")
    with contextlib.closing(Browser(program, tmp_path_factory.mktemp("browser") / "profile")) as browser:
        browser.attach()
        yield browser


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("page")


@pytest.fixture
def page(browser, folder):
    return opened(browser, folder)
