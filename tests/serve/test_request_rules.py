"""Whom the preview answers."""

from __future__ import annotations

import pytest

from archgen.serve.site_server import find_refusal


def ask(host: str | None, names: tuple[str, ...] = ("127.0.0.1",), **others: str) -> str:
    headers: dict[str, str | None] = {"Host": host, "Origin": None, "Sec-Fetch-Site": None, "Sec-Fetch-Mode": None}
    return find_refusal(headers | {name.replace("_", "-"): text for name, text in others.items()}, names, 8470)


@pytest.mark.parametrize(
    "host", ["localhost:8470", "LOCALHOST:8470", "127.0.0.1:8470", "[::1]:8470", "192.168.7.1:8470", "[fe80::1]:8470"]
)
def test_local_names_and_addresses_of_digits_are_answered(host: str) -> None:
    assert ask(host) == ""
    assert ask(host, Origin=f"http://{host}") == ""


@pytest.mark.parametrize(
    "host",
    [
        None,
        "",
        "evil.example:8470",
        "localhost",
        "localhost:80",
        "localhost:8471",
        "localhost.evil.example:8470",
        "evil.example:8470@localhost:8470",
        "localhost:8470/",
        "127.0.0.1.nip.io:8470",
        "[::1:8470",
        "localhost:x",
        "0x7f000001:8470",
        "2130706433:8470",
    ],
)
def test_other_names_are_refused(host: str | None) -> None:
    assert ask(host) == "this address is not the one that is served here"


def test_a_name_that_was_asked_for_is_answered() -> None:
    assert ask("robot.lan:8470", ("robot.lan",)) == ""
    assert ask("Robot.LAN:8470", ("robot.lan",)) == ""
    assert ask("other.lan:8470", ("robot.lan",)) != ""


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "null", "https://localhost:8470", "http://localhost:9000", "http://127.0.0.1:8470", ""],
)
def test_other_origins_are_refused(origin: str) -> None:
    assert ask("localhost:8470", Origin=origin) == "another site may not ask"


def test_what_another_site_loads_is_refused_and_its_links_are_not() -> None:
    for site in ("cross-site", "same-site"):
        assert ask("localhost:8470", Sec_Fetch_Site=site, Sec_Fetch_Mode="no-cors") != ""
        assert ask("localhost:8470", Sec_Fetch_Site=site, Sec_Fetch_Mode="navigate") == ""
    assert ask("localhost:8470", Sec_Fetch_Site="same-origin", Sec_Fetch_Mode="cors") == ""
    assert ask("localhost:8470", Sec_Fetch_Site="none", Sec_Fetch_Mode="navigate") == ""
