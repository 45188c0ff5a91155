"""Chromium without a screen, led over a pipe by the DevTools protocol."""

import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import time

CHROMIUM = shutil.which("chromium")
OPTIONS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run", "--disable-dev-shm-usage",
    "--disable-extensions",
    "--disable-background-networking", "--disable-component-update",
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
    "--remote-debugging-pipe",
)  # fmt: skip
SECONDS = 120.0
# The numbers that Chromium reads commands from and writes answers to.
COMMANDS, ANSWERS = 3, 4


class Browser:
    """One page, without network unless it is of this machine (`network`); use it in a `with`. console: what pages wrote
    there or went wrong; requests: every address asked for."""

    def __init__(self, profile, network=False):
        self._network = network
        self.console, self.requests, self._number, self._rest, self._session = [], [], 0, b"", None
        read, self._commands = os.pipe()
        self._answers, write = os.pipe()
        theirs = [fcntl.fcntl(each, fcntl.F_DUPFD, 100) for each in (read, write)]

        def places():
            os.dup2(theirs[0], COMMANDS)
            os.dup2(theirs[1], ANSWERS)

        self._process = subprocess.Popen(
            [CHROMIUM, *OPTIONS, f"--user-data-dir={profile}"], pass_fds=(COMMANDS, ANSWERS), preexec_fn=places,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        for each in (read, write, *theirs):
            os.close(each)

    def __enter__(self):
        target = self._call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self._call(f"{domain}.enable")
        self._call(
            "Network.emulateNetworkConditions",
            offline=not self._network,
            latency=0,
            downloadThroughput=-self._network,
            uploadThroughput=-self._network,
        )
        return self

    def __exit__(self, *failure):
        self._process.terminate()
        try:
            self._process.wait(20)
        except subprocess.TimeoutExpired:
            self._process.kill()
        os.close(self._commands)
        os.close(self._answers)

    def open(self, file, width, height):
        self._call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self._call("Page.navigate", url=file.as_uri())
        self.wait(
            "document.readyState === 'complete' && (!document.querySelector('.curves') ||"
            " document.documentElement.dataset.ready === 'yes')"
        )

    def visit(self, address, width, height):
        """A page of a server on this machine."""
        self._call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self._call("Page.navigate", url=address)

    def value(self, expression):
        found = self._call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def wait(self, condition):
        end = time.monotonic() + SECONDS
        while not self.value(condition):
            assert time.monotonic() < end, f"never came true: {condition}"
            time.sleep(0.05)

    def photograph(self, file):
        file.write_bytes(base64.b64decode(self._call("Page.captureScreenshot", format="png")["data"]))

    def _call(self, method, **parameters):
        self._number += 1
        number, message = self._number, {"id": self._number, "method": method, "params": parameters}
        os.write(
            self._commands,
            json.dumps(message | ({"sessionId": self._session} if self._session else {})).encode() + b"\0",
        )
        while True:
            answer = self._next()
            if answer.get("id") == number:
                assert "error" not in answer, f"{method}: {answer['error']}"
                return answer["result"]
            self._note(answer)

    def _next(self):
        end = time.monotonic() + SECONDS
        while b"\0" not in self._rest:
            assert select.select([self._answers], [], [], max(0.0, end - time.monotonic()))[0], (
                "Chromium does not answer"
            )
            part = os.read(self._answers, 1 << 20)
            assert part, f"Chromium has ended with exit code {self._process.poll()}"
            self._rest += part
        message, _, self._rest = self._rest.partition(b"\0")
        return json.loads(message)

    def _note(self, event):
        said = event.get("params", {})
        if event.get("method") == "Network.requestWillBeSent":
            self.requests.append(said["request"]["url"])
        elif event.get("method") in ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded"):
            # The graphics driver tells how fast it is; pages say nothing of that kind.
            if said.get("entry", {}).get("source") != "rendering":
                self.console.append(said)
