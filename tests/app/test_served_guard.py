"""The guard in front of the running server: NiceGUI's own routes and its websocket are behind it."""

from __future__ import annotations

from collections.abc import Iterator
from http.client import HTTPConnection
from urllib.parse import urlsplit

import pytest
from served import LARGEST, Served, require_nicegui, served

SOCKET = "/_nicegui_ws/socket.io/?EIO=4&transport=websocket"
UPGRADE = {
    "Upgrade": "websocket",
    "Connection": "Upgrade",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
}


@pytest.fixture(scope="module")
def server() -> Iterator[Served]:
    require_nicegui()
    with served() as running:
        yield running


@pytest.fixture(scope="module")
def cookie(server: Served) -> str:
    parts = urlsplit(server.address)
    status, headers = asked(server, f"{parts.path}?{parts.query}")
    assert status == 303
    return headers["set-cookie"].partition(";")[0]


def asked(
    server: Served, path: str, method: str = "GET", **headers: str
) -> tuple[int, dict[str, str]]:
    """Status and headers of one answer."""
    connection = HTTPConnection("127.0.0.1", server.port, timeout=20)
    try:
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        connection.request(method, path, headers=named)
        answer = connection.getresponse()
        return answer.status, {name.lower(): value for name, value in answer.getheaders()}
    finally:
        connection.close()


def test_the_page_and_its_parts_need_the_token(server: Served, cookie: str) -> None:
    assert asked(server, "/")[0] == 403
    assert asked(server, "/?token=wrong")[0] == 403
    assert asked(server, SOCKET.replace("websocket", "polling"))[0] == 403
    status, headers = asked(server, "/", Cookie=cookie)
    assert status == 200
    assert "frame-ancestors 'none'" in headers["content-security-policy"]


def test_a_foreign_host_and_a_foreign_origin_are_refused(server: Served, cookie: str) -> None:
    assert asked(server, "/", Cookie=cookie, Host=f"rebound.example:{server.port}")[0] == 421
    assert asked(server, "/", Cookie=cookie, Origin="https://example.org")[0] == 403


def test_a_websocket_is_opened_to_our_own_page_only(server: Served, cookie: str) -> None:
    own = f"http://127.0.0.1:{server.port}"
    known = UPGRADE | {"Cookie": cookie}
    assert asked(server, SOCKET, **known, Origin=own)[0] == 101
    assert asked(server, SOCKET, **known, Origin="https://example.org")[0] == 403
    assert asked(server, SOCKET, **known)[0] == 403
    assert asked(server, SOCKET, **UPGRADE, Origin=own)[0] == 403
    rebound = f"rebound.example:{server.port}"
    assert asked(server, SOCKET, **known, Origin=f"http://{rebound}", Host=rebound)[0] == 403


def test_an_upload_over_the_limit_is_refused(server: Served, cookie: str) -> None:
    own = f"http://127.0.0.1:{server.port}"
    length = str(LARGEST + 2_000_000)
    status, _ = asked(server, "/", "POST", Cookie=cookie, Origin=own, Content_Length=length)
    assert status == 413
