"""The page on this machine: a web server on the loopback address, whose address has a token that nobody guesses."""

from __future__ import annotations

import asyncio
import json
import secrets
from collections.abc import Callable
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from aiohttp import WSCloseCode, WSMsgType, web

from fenics_gears import SceneError, as_toml
from fenics_gears.pages import colours
from fenics_gears.scene_text import Models, Tree

from .computing import FILES, PICTURES, REPORT, RESULT, STRESS, Work
from .process import ComputingProcess
from .session import Session
from .settled import is_slow, settled

HOST = "127.0.0.1"
TYPES = {".js": "text/javascript", ".css": "text/css", ".html": "text/html"}
ENDINGS = {PICTURES: "zip", RESULT: "nc"}
# What the browser shows.
SHOWN = {REPORT: "text/html", STRESS: "image/png"}


class LiveServer:
    """Serves one session to any number of browsers. `started`: is called with the address."""

    def __init__(self, tree: Tree, model: Any, name: str, folder: Path):
        self._token = secrets.token_urlsafe(24)
        self._sockets: set[web.WebSocketResponse] = set()
        self._files: list[asyncio.Future[bytes]] = []
        self._process = ComputingProcess(name, str(folder))
        tree = settled(tree, model, Models(name, folder))
        self.session = Session(tree, name, is_slow(tree, model), self._process.send, self._tell)

    async def run(self, port: int, started: Callable[[str], None]) -> None:
        """Serve until the task is cancelled. Raises SceneError where the port is taken."""
        runner = web.AppRunner(self._application(), access_log=None)
        await runner.setup()
        loop = asyncio.get_running_loop()
        self._process.start(lambda answer: loop.call_soon_threadsafe(self._answered, answer))
        try:
            try:
                await web.TCPSite(runner, HOST, port).start()
            except OSError as error:
                raise SceneError(f"--port {port}: {error.strerror or error}. Take another, or leave it out.") from None
            started(f"http://{HOST}:{runner.addresses[0][1]}/{self._token}/")
            self.session.run()
            await asyncio.Event().wait()
        finally:
            self._process.end()
            await asyncio.gather(*(each.close(code=WSCloseCode.GOING_AWAY) for each in set(self._sockets)))
            await runner.cleanup()

    def _application(self) -> web.Application:
        application = web.Application(middlewares=[self._of_this_page])
        home = f"/{self._token}/"
        application.router.add_get(home, self._page)
        application.router.add_get(f"{home}socket", self._socket)
        application.router.add_get(f"{home}plotly.js", self._plotly)
        application.router.add_get(f"{home}scene.toml", self._scene)
        application.router.add_get(f"{home}{{kind:{'|'.join(FILES)}}}", self._file)
        application.router.add_get(f"{home}{{name:live\\.(?:js|css)}}", self._own)
        return application

    @web.middleware
    async def _of_this_page(self, request: web.Request, handler: Any) -> web.StreamResponse:
        """Nothing without the token in the address; no other page in the browser can connect either."""
        given = request.path.split("/")[1]
        if not secrets.compare_digest(given.encode(), self._token.encode()):
            raise web.HTTPForbidden(text="This address lacks its token. Copy the whole address from the terminal.\n")
        origin = request.headers.get("Origin")
        if origin is not None and origin != f"{request.scheme}://{request.host}":
            raise web.HTTPForbidden(text="Another page may not use this one.\n")
        return await handler(request)

    async def _page(self, request: web.Request) -> web.Response:
        response = web.Response(text=_own_file("live.html"), content_type="text/html")
        response.headers["Content-Security-Policy"] = (
            "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; worker-src blob:;"
            " frame-ancestors http://localhost:* http://127.0.0.1:*"
        )
        return response

    async def _own(self, request: web.Request) -> web.Response:
        name = request.match_info["name"]
        shared = colours() if name.endswith(".css") else ""
        return web.Response(text=shared + _own_file(name), content_type=TYPES[name[name.rindex(".") :]])

    async def _plotly(self, request: web.Request) -> web.Response:
        return web.Response(text=_plotly_library(), content_type="text/javascript")

    async def _scene(self, request: web.Request) -> web.Response:
        return _download(as_toml(self.session.tree).encode(), f"{self.session.name}.toml", "application/toml")

    async def _file(self, request: web.Request) -> web.Response:
        kind = request.match_info["kind"]
        future: asyncio.Future[bytes] = asyncio.get_running_loop().create_future()
        self._files.append(future)
        self._process.send(Work(kind, self.session.number))
        try:
            content = await future
        except SceneError as error:
            raise web.HTTPConflict(text=f"{error}\n") from None
        if kind in SHOWN:
            return web.Response(body=content, content_type=SHOWN[kind], charset="utf-8" if kind == REPORT else None)
        return _download(content, f"{self.session.name}.{ENDINGS[kind]}", "application/octet-stream")

    async def _socket(self, request: web.Request) -> web.WebSocketResponse:
        socket = web.WebSocketResponse(heartbeat=20.0, max_msg_size=1 << 20)
        await socket.prepare(request)
        self._sockets.add(socket)
        try:
            for message in self.session.messages:
                await socket.send_str(json.dumps(message, allow_nan=False, separators=(",", ":")))
            async for received in socket:
                if received.type == WSMsgType.TEXT:
                    self.session.do(json.loads(received.data))
        finally:
            self._sockets.discard(socket)
        return socket

    def _answered(self, answer: dict[str, Any]) -> None:
        """What the computing process says: a file goes to the browser that waits for it, all else to everybody."""
        if answer.get("of") in FILES:
            future = self._files.pop(0)
            if not future.done():
                if answer["kind"] == "file":
                    future.set_result(answer["content"])
                else:
                    future.set_exception(SceneError(answer["message"]))
            return
        if answer["kind"] == "ended":
            while self._files:
                self._files.pop().set_exception(SceneError(answer["message"]))
            answer = {"kind": "failed", "number": self.session.number, "message": answer["message"]}
        self.session.answered(answer)

    def _tell(self, message: Any) -> None:
        text = json.dumps(message, allow_nan=False, separators=(",", ":"))
        for socket in set(self._sockets):
            task = asyncio.ensure_future(socket.send_str(text))
            task.add_done_callback(lambda done: done.cancelled() or done.exception())


def _download(content: bytes, name: str, kind: str) -> web.Response:
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return web.Response(body=content, content_type=kind, headers=headers)


def _own_file(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


@cache
def _plotly_library() -> str:
    from plotly.offline import get_plotlyjs

    return get_plotlyjs()
