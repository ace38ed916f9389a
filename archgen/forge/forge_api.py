"""Call a forge's API: JSON over HTTPS, to the one host that the job names, with a time limit and no redirects."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator, Mapping
from http.client import HTTPException
from typing import Any, TypeVar
from urllib.error import HTTPError, URLError
from urllib.parse import urlsplit
from urllib.request import HTTPRedirectHandler, Request, build_opener

from archgen.frozen import dataclass

_TIMEOUT_SECONDS = 30
_MAX_ANSWER_BYTES = 64 * 1024 * 1024
_PAGE_SIZE = 100
_MAX_PAGES = 50
"""5,000 items. A server that always has another full page would be asked for ever."""
_LOOPBACK_HOSTS = frozenset({"127.0.0.1", "::1", "localhost"})


class ForgeError(Exception):
    """The forge did not do what was asked. The message says why; `status` is HTTP's, 0 where there was no answer."""

    def __init__(self, message: str, status: int = 0) -> None:
        super().__init__(message)
        self.status = status


class _NoRedirects(HTTPRedirectHandler):
    """Refuses redirects: a token is for one host, so an answer that leads elsewhere is an error."""

    def redirect_request(self, *_: Any, **__: Any) -> None:  # noqa: ANN401 - whatever urllib passes
        """Follow nothing."""


@dataclass(frozen=True, slots=True)
class ForgeApi:
    """A forge's API: its address, and the headers that authenticate."""

    url: str
    headers: Mapping[str, str]

    def __post_init__(self) -> None:
        """Refuse to send a token over a line that anybody can read."""
        try:
            url_parts = urlsplit(self.url)
        except ValueError as error:
            raise ForgeError(f"the API's address {self.url!r} is no address: {error}") from None
        if url_parts.scheme != "https" and not (url_parts.scheme == "http" and url_parts.hostname in _LOOPBACK_HOSTS):
            raise ForgeError(f"the API's address {self.url!r} does not begin with https://")

    def list_items(self, path: str, noun: str) -> Iterator[Any]:
        """Yield the items of a list, page after page; `noun` says in an error what there are too many of. Raise ForgeError."""
        separator = "&" if "?" in path else "?"
        for page in range(1, _MAX_PAGES + 1):
            items = self.send_request("GET", f"{path}{separator}per_page={_PAGE_SIZE}&page={page}")
            if not isinstance(items, list):
                raise ForgeError(f"the list of {noun} is no list")
            yield from items
            # A short page is the last one; the Link header is not needed.
            if len(items) < _PAGE_SIZE:
                return
        raise ForgeError(f"there are more than {_MAX_PAGES * _PAGE_SIZE:,} {noun}")

    def send_request(self, method: str, path: str, body: Mapping[str, Any] | None = None) -> Any:  # noqa: ANN401 - JSON
        """Send one request and return its answer as plain data. Raise ForgeError."""
        data = json.dumps(body).encode() if body is not None else None
        headers = {"Accept": "application/json", "Content-Type": "application/json", "User-Agent": "archgen"}
        request = Request(f"{self.url}{path}", data, {**headers, **self.headers}, method=method)  # noqa: S310 - see above
        try:
            with build_opener(_NoRedirects).open(request, timeout=_TIMEOUT_SECONDS) as answer:
                return json.loads(answer.read(_MAX_ANSWER_BYTES))
        except HTTPError as error:
            error.close()  # it holds the connection
            raise ForgeError(f"{method} {path} was answered with {error.code} {error.reason}", error.code) from None
        except (URLError, TimeoutError, HTTPException) as error:
            raise ForgeError(f"{method} {path} got no answer: {getattr(error, 'reason', error)}") from None
        except (ValueError, RecursionError):
            raise ForgeError(f"{method} {path} was answered with something that is no JSON") from None


T = TypeVar("T")


def run_within(seconds: float, function: Callable[[], T]) -> T:
    """Call a function and return its result; raise ForgeError where it takes longer, and whatever it raises.

    It runs in a thread of its own, since sockets limit the wait for the next byte only. A thread that is not ready in
    time is left behind: it ends with the process.
    """
    results: list[T] = []
    errors: list[BaseException] = []

    def run() -> None:
        try:
            results.append(function())
        except BaseException as error:  # noqa: BLE001 - raised again below, in the thread that called
            errors.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join(seconds)
    if errors:
        raise errors[0]
    if not results:
        raise ForgeError(f"no answer within {seconds:g} s")
    return results[0]
