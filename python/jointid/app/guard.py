"""Access control of the page: only this machine's browser, with the token of this start, and small uploads.

A loopback address does not protect: any page in a browser may send requests to it. A name that points to
127.0.0.1 after it was loaded (DNS rebinding) makes these requests look like same-origin requests. Therefore
the Host and the Origin must be ours, also for a websocket. Every request except the first needs the cookie
that the server sets in exchange for the token.
"""

from __future__ import annotations

import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Application = Callable[[Scope, Receive, Send], Awaitable[None]]

_POLICY = (
    "default-src 'self' data: blob:; script-src 'self' 'unsafe-inline' 'unsafe-eval' blob:; "
    "style-src 'self' 'unsafe-inline'; connect-src 'self'; frame-ancestors 'none'; base-uri 'self'; form-action 'self'"
)


class Guard:
    """An ASGI application that filters the requests to another one.

    Parameters
    ----------
    app : ASGI application
    port : int
        Port of the server.
    token : str
        Token of this start.
    largest : int
        Largest number of bytes in a request's body.
    """

    def __init__(self, app: Application, *, port: int, token: str, largest: int) -> None:
        self._app = app
        self._hosts = {f"{host}:{port}" for host in ("127.0.0.1", "localhost")}
        self._origins = {f"http://{host}" for host in self._hosts}
        self._token = token
        self._cookie = f"jointid-{port}"
        self._largest = largest

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on allowed requests."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        headers = [
            (name.decode("latin-1"), value.decode("latin-1")) for name, value in scope["headers"]
        ]
        refusal = self._refusal(scope, headers)
        if refusal is not None:
            await _refuse(scope, receive, send, *refusal)
            return
        if self._token_given(scope):
            await _answer(
                send,
                303,
                "",
                (b"location", b"/"),
                (
                    b"set-cookie",
                    f"{self._cookie}={self._token}; HttpOnly; SameSite=Strict; Path=/".encode(),
                ),
            )
            return
        if not self._has_cookie(headers):
            await _refuse(
                scope,
                receive,
                send,
                403,
                "open the page at the address that `jointid app` printed; it contains the token of this start",
            )
            return
        await self._app(scope, self._counted(receive), _with_policy(send))

    def _refusal(self, scope: Scope, headers: list[tuple[str, str]]) -> tuple[int, str] | None:
        hosts = [value.lower() for name, value in headers if name == "host"]
        if len(hosts) != 1 or hosts[0] not in self._hosts:
            return (
                421,
                "this page is served to this machine only, at the address that `jointid app` printed",
            )
        origins = [value.lower() for name, value in headers if name == "origin"]
        if any(origin not in self._origins for origin in origins):
            return 403, "requests from pages of another origin are refused"
        if scope["type"] == "websocket" and not origins:
            return 403, "the websocket has no origin, so it is not from a browser"
        for name, value in headers:
            if name == "content-length" and (not value.isdigit() or int(value) > self._largest):
                return (
                    413,
                    f"the file is larger than {self._largest / 1e6:.0f} MB, the limit of an upload",
                )
        return None

    def _token_given(self, scope: Scope) -> bool:
        if scope["type"] != "http" or scope["method"] != "GET" or scope["path"] != "/":
            return False
        given = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [])
        return len(given) == 1 and _same(given[0], self._token)

    def _has_cookie(self, headers: list[tuple[str, str]]) -> bool:
        for name, value in headers:
            if name != "cookie":
                continue
            try:
                cookie = SimpleCookie(value).get(self._cookie)
            except CookieError:
                continue
            if cookie is not None and _same(cookie.value, self._token):
                return True
        return False

    def _counted(self, receive: Receive) -> Receive:
        """Receive at most the accepted number of bytes, because a body may come without its length."""
        total = 0

        async def counted() -> Message:
            nonlocal total
            message = await receive()
            if message["type"] == "http.request":
                total += len(message.get("body", b""))
                if total > self._largest:
                    return {"type": "http.disconnect"}
            return message

        return counted


def new_token() -> str:
    """Return a token for one start."""
    return secrets.token_urlsafe(32)


def _same(given: str, expected: str) -> bool:
    return secrets.compare_digest(given.encode(), expected.encode())


def _with_policy(send: Send) -> Send:
    """Prevent pages from loading foreign content and from being framed."""

    async def sent(message: Message) -> None:
        if message["type"] == "http.response.start":
            message["headers"] = [
                *message.get("headers", []),
                (b"content-security-policy", _POLICY.encode()),
                (b"referrer-policy", b"no-referrer"),
                (b"x-content-type-options", b"nosniff"),
            ]
        await send(message)

    return sent


async def _refuse(scope: Scope, receive: Receive, send: Send, status: int, reason: str) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008, "reason": reason})
        return
    await _answer(send, status, reason)


async def _answer(send: Send, status: int, text: str, *headers: tuple[bytes, bytes]) -> None:
    body = text.encode()
    await send(
        {
            "type": "http.response.start",
            "status": status,
            "headers": [
                (b"content-type", b"text/plain; charset=utf-8"),
                (b"content-length", str(len(body)).encode()),
                (b"connection", b"close"),
                *headers,
            ],
        }
    )
    await send({"type": "http.response.body", "body": body})
