"""A server that plays the forge: it holds requests and comments, and remembers what it was asked."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import pytest


@dataclass
class Forge:
    """What the server holds, and what it was asked."""

    comments: list[dict[str, Any]] = field(default_factory=list)
    pulls: list[dict[str, Any]] = field(default_factory=list)
    user: dict[str, Any] | None = None
    refuse: int = 0
    asked: list[tuple[str, str]] = field(default_factory=list)
    tokens: set[str] = field(default_factory=set)
    url: str = ""


def select_requests(held: Forge, query: dict[str, list[str]]) -> list[dict[str, Any]]:
    """Give the open requests of a branch, or to one."""
    if query["state"] not in (["open"], ["opened"]):
        return []
    if "head" in query:
        return [one for one in held.pulls if one["head"]["label"] == query["head"][0]]
    return held.pulls if (query.get("base") or query["target_branch"]) == ["main"] else []


def select_comments(held: Forge, path: str) -> list[dict[str, Any]]:
    """Give the comments of one request; what a test put there itself is on all of them."""
    comments = [one for one in held.comments if not isinstance(one, dict) or one.get("at", path) == path]
    return comments if len(comments) < len(held.comments) else held.comments


@pytest.fixture
def forge() -> Iterator[Forge]:
    held = Forge()

    class Handler(BaseHTTPRequestHandler):
        def answer(self) -> None:
            parts = urlsplit(self.path)
            held.asked.append((self.command, parts.path))
            held.tokens.update(self.headers.get_all("Authorization", []) + self.headers.get_all("PRIVATE-TOKEN", []))
            body = json.loads(self.rfile.read(int(self.headers.get("Content-Length", 0))) or "null")
            status, data = reply(self.command, parts.path, parse_qs(parts.query), body)
            self.send_response(status)
            if status == 302:
                self.send_header("Location", "http://127.0.0.1:1/")
            self.end_headers()
            self.wfile.write(data if isinstance(data, bytes) else json.dumps(data).encode())

        do_GET = do_POST = do_PATCH = do_PUT = answer  # noqa: N815 - the server's names

        def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the server's name
            pass

    def reply(method: str, path: str, query: dict[str, list[str]], body: Any) -> tuple[int, object]:  # noqa: ANN401
        if path == "/user":
            return (200, held.user) if held.user else (403, {})
        if path.endswith(("/pulls", "/merge_requests")):
            size, page = int(query["per_page"][0]), int(query.get("page", ["1"])[0])
            return 200, select_requests(held, query)[size * (page - 1) : size * page]
        if held.refuse and method != "GET":
            return held.refuse, {}
        if method == "GET":
            size, page = int(query["per_page"][0]), int(query["page"][0])
            return 200, select_comments(held, path)[size * (page - 1) : size * page]
        if method == "POST":
            held.comments.append(
                {"id": len(held.comments) + 1, "user": held.user or bot, "author": held.user, "at": path, **body}
            )
            return 201, {}
        wanted = int(path.rsplit("/", 1)[1])
        next(one for one in held.comments if one["id"] == wanted).update(body)
        return 200, {}

    bot = {"login": "github-actions[bot]"}
    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, args=(0.01,))
    thread.start()
    held.url = f"http://127.0.0.1:{server.server_port}"
    yield held
    server.shutdown()
    thread.join()
    server.server_close()


def github(forge: Forge, tmp_path: Path, event: object = None) -> dict[str, str]:
    file = tmp_path / "event.json"
    file.write_text(json.dumps({"pull_request": {"number": 7}} if event is None else event))
    return {
        "GITHUB_ACTIONS": "true",
        "GITHUB_TOKEN": "secret",
        "GITHUB_REPOSITORY": "robots/rover",
        "GITHUB_API_URL": forge.url,
        "GITHUB_EVENT_PATH": str(file),
    }


def gitlab(forge: Forge) -> dict[str, str]:
    return {
        "GITLAB_CI": "true",
        "ARCHGEN_TOKEN": "secret",
        "CI_API_V4_URL": forge.url,
        "CI_PROJECT_ID": "12",
        "CI_MERGE_REQUEST_IID": "3",
    }
