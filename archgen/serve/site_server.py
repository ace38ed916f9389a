"""The server of the live preview: pages and news over HTTP, from memory and to this machine alone unless told otherwise."""

from __future__ import annotations

import contextlib
import ipaddress
import json
import socket
import sys
import threading
from collections.abc import Collection, Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import PurePosixPath
from typing import Any
from urllib.parse import parse_qs, unquote, urlsplit

from archgen.serve import what_if
from archgen.serve.live_site import LiveSite, StoppedError

_LOCAL_NAMES = frozenset({"localhost"})


def find_refusal(headers: Mapping[str, str | None], served_names: Collection[str], port: int) -> str:
    """Return why a request is refused, empty if it is not.

    `headers` are `Host`, `Origin`, `Sec-Fetch-Site` and `Sec-Fetch-Mode` of the request, None where it has none.
    """
    host = headers.get("Host") or ""
    if not _is_own_address(host, served_names, port):
        return "this address is not the one that is served here"
    origin = headers.get("Origin")
    if origin is not None and origin.lower() != f"http://{host.lower()}":
        return "another site may not ask"
    # Scripts that are loaded across sites carry no Origin, and the files of the search are scripts.
    is_foreign = (headers.get("Sec-Fetch-Site") or "none") not in {"none", "same-origin"}
    if is_foreign and headers.get("Sec-Fetch-Mode") != "navigate":
        return "another site may not load this"
    return ""


def _is_own_address(host: str, served_names: Collection[str], port: int) -> bool:
    """Whether a `Host` means this server: its name and its port."""
    try:
        address = urlsplit(f"//{host}")
        name, asked_port = address.hostname or "", address.port
    except ValueError:
        return False
    if address.username is not None or address.path or (asked_port or 80) != port:
        return False
    return name in _LOCAL_NAMES or name in {each.lower() for each in served_names} or _is_ip_address(name)


def _is_ip_address(name: str) -> bool:
    """Whether a name is an address of digits."""
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


_CONTENT_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".jpg": "image/jpeg",
    ".gif": "image/gif",
    ".webp": "image/webp",
    ".woff2": "font/woff2",
    ".ttf": "font/ttf",
    ".wasm": "application/wasm",
    ".json": "application/json",
}
_FIXED_HEADERS = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}
_FRAMING_EDITORS = "vscode-webview: https://*.vscode-cdn.net"
"""Where Visual Studio Code, on the desktop and in the browser, frames a page beside the text."""
_MAX_QUESTION_BYTES = 100_000
_MAX_STREAMS = 100
"""So many pages may wait for news at once: each holds a thread."""
MAX_CONNECTIONS = 200
"""So many may be open at once: each holds a thread, also one on which nothing is asked."""
_BREATH = 15.0
"""Seconds after which a line is sent to a page that waits for news, to notice that it is gone."""


class SiteServer(ThreadingHTTPServer):
    """Serves one live site. Raises OSError where the port is taken."""

    daemon_threads = True
    # On Windows this would let two servers share one port.
    allow_reuse_address = sys.platform != "win32"

    def __init__(self, live_site: LiveSite, host: str, port: int, *, in_editor: bool = False) -> None:
        """Take the port (0: any that is free), and answer nobody yet. Only an editor may frame the pages, where one does."""
        self.address_family = socket.AF_INET6 if ":" in host else socket.AF_INET
        super().__init__((host, port), _RequestHandler)
        self.live_site = live_site
        self.framed_by = _FRAMING_EDITORS if in_editor else "'none'"
        self.served_names = (host, socket.gethostname()) if host not in {"localhost", "127.0.0.1", "::1"} else (host,)
        self.streams = threading.BoundedSemaphore(_MAX_STREAMS)
        self._connections = threading.BoundedSemaphore(MAX_CONNECTIONS)
        self.question_lock = threading.Lock()

    def server_bind(self) -> None:
        """Take the port without asking who this machine is called, which may take seconds."""
        if self.allow_reuse_address:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.bind(self.server_address)
        self.server_address = self.socket.getsockname()
        self.server_name, self.server_port = str(self.server_address[0]), int(self.server_address[1])

    @property
    def url(self) -> str:
        """The address of the start page."""
        host = str(self.server_address[0])
        if _is_ip_address(host) and host in {"0.0.0.0", "::"}:  # noqa: S104 - recognised, not chosen
            host = "localhost"
        return f"http://{f'[{host}]' if ':' in host else host}:{self.server_port}/"

    def process_request(self, request: socket.socket, client_address: object) -> None:  # type: ignore[override]
        """Answer in a thread, or end a connection beyond those that may be open."""
        if self._connections.acquire(blocking=False):
            super().process_request(request, client_address)
        else:
            self.shutdown_request(request)

    def process_request_thread(self, request: socket.socket, client_address: object) -> None:  # type: ignore[override]
        """Answer all that is asked on one connection."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._connections.release()

    def handle_error(self, request: object, client_address: object) -> None:  # noqa: ARG002 - the signature of socketserver
        """Say in one line what went wrong; a reader who went away is nothing wrong."""
        error = sys.exception() if hasattr(sys, "exception") else sys.exc_info()[1]
        if error is not None and not isinstance(error, OSError):
            sys.stderr.write(f"archgen serve: {type(error).__name__}: {error}\n")


class _RequestHandler(BaseHTTPRequestHandler):
    """Answers one reader."""

    server: SiteServer
    protocol_version = "HTTP/1.1"
    server_version = "archgen"
    sys_version = ""
    timeout = 60
    """Seconds after which a reader who sends nothing is forgotten."""

    def do_GET(self) -> None:
        """Send a file of the site, or the news as they come."""
        if self._refuse():
            return
        path, query = self._split_path()
        if path == "live/news":
            self._send_news()
        elif path == "live/what-if":
            self._send_figures(query)
        else:
            self._send_file(path)

    def do_HEAD(self) -> None:
        """Send what GET would send, without the file."""
        if not self._refuse():
            self._send_file(self._split_path()[0])

    def do_POST(self) -> None:
        """Answer what would be if some figures were others."""
        # Whatever goes wrong, what was sent may be unread: the next request would begin in the middle of it.
        self.close_connection = True
        if self._refuse():
            return
        if self._split_path()[0] != "live/what-if":
            self._send_text(HTTPStatus.NOT_FOUND, "there is nothing here to ask")
            return
        content_type = (self.headers.get("Content-Type") or "").partition(";")[0].strip().lower()
        if content_type != "application/json":
            self._send_text(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, "send JSON, as application/json")
            return
        length = self.headers.get("Content-Length") or ""
        if not length.isascii() or not length.isdigit():
            self._send_text(HTTPStatus.LENGTH_REQUIRED, "say in Content-Length how many bytes are sent")
        elif len(length) > 9 or int(length) > _MAX_QUESTION_BYTES:  # noqa: PLR2004 - a number of bytes, not of digits
            self._send_text(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"at most {_MAX_QUESTION_BYTES} bytes")
        else:
            self._answer_question(self.rfile.read(int(length)))

    def _answer_question(self, data: bytes) -> None:
        state = self.server.live_site.state
        if state is None:
            self._send_text(HTTPStatus.SERVICE_UNAVAILABLE, "the project is not read yet")
            return
        try:
            overrides = what_if.read_question(data)
        except what_if.QuestionError as error:
            self._send_json(HTTPStatus.BAD_REQUEST, {"error": str(error)})
            return
        # One at a time: each takes a whole processor.
        with self.server.question_lock:
            answer = what_if.answer_question(state, overrides)
        self._send_json(HTTPStatus.OK, answer)

    def _refuse(self) -> bool:
        """Answer a request that is not for us, and say whether it was one."""
        names = ("Host", "Origin", "Sec-Fetch-Site", "Sec-Fetch-Mode")
        # Two hosts in one request: somebody between may have judged the other one.
        is_double = len(self.headers.get_all("Host") or ()) != 1
        refusal = (
            "name one host"
            if is_double
            else find_refusal(
                {name: self.headers.get(name) for name in names}, self.server.served_names, self.server.server_port
            )
        )
        if refusal:
            self.close_connection = True
            self._send_text(HTTPStatus.FORBIDDEN, refusal)
        return bool(refusal)

    def _split_path(self) -> tuple[str, dict[str, list[str]]]:
        """Return the path in the site, and what stands behind the question mark."""
        try:
            address = urlsplit(self.path)
            return unquote(address.path).removeprefix("/") or "index.html", parse_qs(address.query)
        except ValueError:
            return "", {}

    def _send_file(self, path: str) -> None:
        try:
            data = self.server.live_site.read_file(path)
        except StoppedError:
            self._send_text(HTTPStatus.SERVICE_UNAVAILABLE, "the preview is starting, or ends")
            return
        content_type = _CONTENT_TYPES.get(PurePosixPath(path).suffix, "application/octet-stream")
        if data is None:
            self._send_text(HTTPStatus.NOT_FOUND, "there is no such page")
        else:
            self._send_data(HTTPStatus.OK, data, content_type)

    def _send_figures(self, query: dict[str, list[str]]) -> None:
        """Send the figures of a chain or of a host that may be tried out."""
        state = self.server.live_site.state
        list_figures = what_if.list_host_figures if "host" in query else what_if.list_figures
        name = (query.get("host") or query.get("chain") or [""])[0]
        figures = list_figures(state, name) if state else ()
        self._send_json(HTTPStatus.OK, {"figures": figures})

    def _send_news(self) -> None:
        """Send the status now and whenever it changes, as server-sent events, until the reader goes or all ends."""
        if not self.server.streams.acquire(blocking=False):
            self._send_text(HTTPStatus.SERVICE_UNAVAILABLE, "too many pages wait for news")
            return
        self.close_connection = True
        try:
            self._send_head(HTTPStatus.OK, {"Content-Type": "text/event-stream", "Connection": "close"})
            version = ""
            while True:
                status = self.server.live_site.wait_for_news(version, _BREATH)
                if status is None:
                    self.wfile.write(b": still here\n\n")
                else:
                    version = status.version
                    self.wfile.write(f"retry: 500\ndata: {status.to_json()}\n\n".encode())
                self.wfile.flush()
        except (OSError, StoppedError):
            return
        finally:
            self.server.streams.release()

    def _send_json(self, status: HTTPStatus, content: Any) -> None:  # noqa: ANN401 - whatever JSON can say
        self._send_data(status, json.dumps(content, ensure_ascii=True).encode(), _CONTENT_TYPES[".json"])

    def _send_text(self, status: HTTPStatus, text: str) -> None:
        self._send_data(status, f"{text}\n".encode(), "text/plain; charset=utf-8")

    def _send_data(self, status: HTTPStatus, data: bytes, content_type: str) -> None:
        headers = {"Content-Type": content_type, "Content-Length": str(len(data))}
        if self.close_connection:
            headers["Connection"] = "close"
        with contextlib.suppress(ConnectionError):
            self._send_head(status, headers)
            if self.command != "HEAD":
                self.wfile.write(data)

    def _send_head(self, status: HTTPStatus, headers: dict[str, str]) -> None:
        self.send_response(status)
        policy = f"frame-ancestors {self.server.framed_by}"
        for name, value in {**_FIXED_HEADERS, "Content-Security-Policy": policy, **headers}.items():
            self.send_header(name, value)
        self.end_headers()

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the signature of http.server
        """Say nothing of each request."""
