"""The server: opens its door on one address, tells where, and closes cleanly on Ctrl-C."""

import socket
import threading
import webbrowser
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

import uvicorn

from slam.serve.application import application
from slam.serve.door import address_of, open_door
from slam.serve.gallery import Gallery, Shown

GRACE = 2  # seconds open connections have to end when the server does


def serve(shown: Shown | None, host: str, port: int, opened: Callable[[str], None]) -> None:
    """Serve the page until Ctrl-C; `opened` is told its address as soon as it answers."""
    with open_door(host, port) as door, TemporaryDirectory(prefix="roomsketch-") as scratch:
        address = address_of(door, host)
        server = _Announcing(
            uvicorn.Config(
                application(Gallery(Path(scratch)), shown, host),
                log_level="error",
                ws="websockets-sansio",
                ws_max_size=1024,
                timeout_graceful_shutdown=GRACE,
                server_header=False,
            ),
            lambda: opened(address),
        )
        with suppress(KeyboardInterrupt):
            server.run(sockets=[door])


def open_browser(address: str) -> None:
    """Show the page to whoever sits here, without waiting for the browser."""
    threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()


class _Announcing(uvicorn.Server):
    """A server that says when it is ready."""

    def __init__(self, config: uvicorn.Config, ready: Callable[[], None]) -> None:
        super().__init__(config)
        self._ready = ready

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start, then tell."""
        await super().startup(sockets)
        self._ready()
