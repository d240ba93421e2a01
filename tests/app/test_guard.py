"""Who may talk to the page, asked without a server."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from jointid.app.guard import Guard, new_token

PORT, TOKEN, LARGEST = 8123, "the-token", 1000
HOST, ORIGIN = f"127.0.0.1:{PORT}", f"http://127.0.0.1:{PORT}"
COOKIE = f"other=1; jointid-{PORT}={TOKEN}"


async def _page(scope: Any, receive: Any, send: Any) -> None:
    """What is behind the guard: it reads all that is sent, and answers 200."""
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.accept"})
        return
    while True:
        message = await receive()
        if message["type"] == "http.disconnect":
            return
        if not message.get("more_body"):
            break
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"the page"})


def asked(
    headers: dict[str, str],
    *,
    kind: str = "http",
    method: str = "GET",
    path: str = "/",
    query: str = "",
    body: tuple[bytes, ...] = (b"",),
) -> list[dict[str, Any]]:
    """What is answered to one request."""
    scope = {
        "type": kind,
        "method": method,
        "path": path,
        "query_string": query.encode(),
        "headers": [(name.encode(), value.encode()) for name, value in headers.items()],
    }
    parts = [
        {"type": "http.request", "body": each, "more_body": k < len(body) - 1}
        for k, each in enumerate(body)
    ]
    coming = iter([{"type": "websocket.connect"}] if kind == "websocket" else parts)
    answers: list[dict[str, Any]] = []

    async def receive() -> Any:
        return next(coming, {"type": "http.disconnect"})

    async def send(message: Any) -> None:
        answers.append(message)

    guard = Guard(_page, port=PORT, token=TOKEN, largest=LARGEST)
    asyncio.run(guard(scope, receive, send))
    return answers


def status(answers: list[dict[str, Any]]) -> int | None:
    return answers[0].get("status") if answers else None


def test_the_token_buys_a_cookie_and_the_cookie_the_page() -> None:
    first = asked({"host": HOST}, query=f"token={TOKEN}")
    headers = dict(first[0]["headers"])
    assert status(first) == 303
    assert headers[b"location"] == b"/"
    cookie = headers[b"set-cookie"].decode()
    assert {"HttpOnly", "SameSite=Strict"} <= {part.strip() for part in cookie.split(";")}
    again = asked({"host": HOST, "cookie": cookie.partition(";")[0]})
    assert status(again) == 200
    assert b"content-security-policy" in dict(again[0]["headers"])


@pytest.mark.parametrize(
    ("headers", "expected"),
    [
        ({"host": HOST, "cookie": COOKIE}, 200),
        (
            {"host": f"localhost:{PORT}", "cookie": COOKIE, "origin": f"http://localhost:{PORT}"},
            200,
        ),
        ({"host": HOST}, 403),
        ({"host": HOST, "cookie": f"jointid-{PORT}=wrong"}, 403),
        ({"host": HOST, "cookie": f"jointid-{PORT + 1}={TOKEN}"}, 403),
        ({"host": HOST, "cookie": "jointid-8123"}, 403),
        ({"host": f"rebound.example:{PORT}", "cookie": COOKIE}, 421),
        ({"host": "127.0.0.1", "cookie": COOKIE}, 421),
        ({"host": f"127.0.0.1:{PORT + 1}", "cookie": COOKIE}, 421),
        ({"cookie": COOKIE}, 421),
        ({"host": HOST, "cookie": COOKIE, "origin": "https://example.org"}, 403),
        ({"host": HOST, "cookie": COOKIE, "origin": "null"}, 403),
        ({"host": HOST, "cookie": COOKIE, "origin": f"https://127.0.0.1:{PORT}"}, 403),
    ],
)
def test_who_is_answered(headers: dict[str, str], expected: int) -> None:
    assert status(asked(headers)) == expected


@pytest.mark.parametrize(
    "query", ["token=wrong", "token=", f"token={TOKEN}&token=x", "TOKEN=the-token"]
)
def test_a_wrong_token_buys_nothing(query: str) -> None:
    assert status(asked({"host": HOST}, query=query)) == 403


def test_a_token_is_taken_at_the_front_page_only() -> None:
    assert status(asked({"host": HOST}, path="/other", query=f"token={TOKEN}")) == 403
    assert status(asked({"host": HOST}, method="POST", query=f"token={TOKEN}")) == 403


@pytest.mark.parametrize(
    ("headers", "kind"),
    [
        ({"host": HOST, "cookie": COOKIE, "origin": ORIGIN}, "websocket.accept"),
        ({"host": HOST, "cookie": COOKIE, "origin": "https://example.org"}, "websocket.close"),
        ({"host": HOST, "cookie": COOKIE}, "websocket.close"),
        ({"host": HOST, "origin": ORIGIN}, "websocket.close"),
        (
            {"host": f"rebound.example:{PORT}", "cookie": COOKIE, "origin": ORIGIN},
            "websocket.close",
        ),
    ],
)
def test_which_websockets_are_opened(headers: dict[str, str], kind: str) -> None:
    assert [each["type"] for each in asked(headers, kind="websocket")] == [kind]


def test_an_upload_over_the_limit_is_refused_with_and_without_its_length() -> None:
    known = {"host": HOST, "cookie": COOKIE, "origin": ORIGIN}
    assert status(asked(known | {"content-length": str(LARGEST)}, method="POST")) == 200
    assert status(asked(known | {"content-length": str(LARGEST + 1)}, method="POST")) == 413
    assert status(asked(known | {"content-length": "many"}, method="POST")) == 413
    fits, exceeds = (b"x" * 500,) * 2, (b"x" * 500,) * 3
    assert status(asked(known, method="POST", body=fits)) == 200
    assert asked(known, method="POST", body=exceeds) == []  # cut off


def test_each_start_has_its_own_token() -> None:
    assert len({new_token() for _ in range(50)}) == 50
    assert len(new_token()) >= 40
