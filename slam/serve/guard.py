"""Who may speak with the server, and what a browser may do with its page.

A page of another site could reach a server on this machine in two ways: by a name that it points here (DNS rebinding),
or by asking across sites with a form or a websocket. The first shows in the Host header, the second in the Origin.
"""

import ipaddress
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocketClose

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self' ws://{host}; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
FIXED_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}
STRANGER = 1008  # policy violation, in the words of the websocket protocol


class Guard:
    """Lets requests through that name this machine and come from its own page, and seals the answers."""

    def __init__(self, app: ASGIApp, host: str) -> None:
        self.app, self.host = app, host

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse strangers; pass on the rest."""
        if scope["type"] not in {"http", "websocket"}:
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        reason = refusal(host, headers.get("origin"), self.host)
        if reason is None:
            await self.app(scope, receive, _sealed(send, host))
        elif scope["type"] == "websocket":
            await WebSocketClose(STRANGER, reason)(scope, receive, send)
        else:
            await PlainTextResponse(reason, 403)(scope, receive, _sealed(send, "localhost"))


def refusal(host: str, origin: str | None, served: str) -> str | None:
    """Why a request with these headers is refused by a server bound to `served`; None where it may pass."""
    name = _name(host)
    if not _is_ours(name, served):
        return f"this server does not answer to the name {name!r}: use its address"
    if origin is not None and urlsplit(origin).netloc.lower() != host.lower():
        return f"a page of {origin!r} may not use this server"
    return None


def is_loopback(host: str) -> bool:
    """Whether only this machine can reach a server bound to `host`."""
    address = _address(host)
    return host == "localhost" if address is None else address.is_loopback


def _is_ours(name: str, served: str) -> bool:
    """A name may be pointed anywhere by whoever owns it, an address may not; of names only our own count."""
    address = _address(name)
    if address is not None:
        return address.is_loopback or not is_loopback(served)
    return name in {"localhost", served.lower()}


def _name(host: str) -> str:
    """The Host header without its port and brackets."""
    return (urlsplit(f"//{host}").hostname or "").lower()


def _address(name: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    try:
        return ipaddress.ip_address(name)
    except ValueError:
        return None


def _sealed(send: Send, host: str) -> Send:
    """Answers with the headers that keep the page to itself."""

    async def sealed(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            headers["Content-Security-Policy"] = POLICY.format(host=host)
            headers.update(FIXED_HEADERS)
        await send(message)

    return sealed
