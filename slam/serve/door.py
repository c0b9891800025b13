"""The door: the listening socket of the server, and the address that leads to it."""

import socket


class DoorError(Exception):
    """An address that cannot be served; the message says what to choose instead."""


def open_door(host: str, port: int) -> socket.socket:
    """A listening socket. Raises DoorError."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family)
    except (OSError, OverflowError) as reason:
        raise DoorError(
            f"port {port} on {host} cannot be opened ({reason}): choose another with --port, or --port 0 for a free one"
        ) from reason


def address_of(door: socket.socket, host: str) -> str:
    """What to type into a browser on this machine."""
    shown = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}.get(host, f"[{host}]" if ":" in host else host)
    return f"http://{shown}:{door.getsockname()[1]}/"
