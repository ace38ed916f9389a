"""Stands in for a program of a robot: says what it was told, fails unless what it needs runs, offers its port.

Run as `stand_in.py FOLDER PROGRAM WORD...`; FOLDER holds settings.json and what the stand-ins tell of themselves.
"""

# ruff: noqa: T201
import json
import os
import signal
import socket
import sys
import time
from pathlib import Path


def main() -> None:
    folder, program, *words = Path(sys.argv[1]), *sys.argv[2:]
    settings = json.loads((folder / "settings.json").read_text())
    if program == "ros2" and words[0] != "run":
        answer(folder, settings, words)
        return
    node = [word.partition(":=")[2] for word in words if word.startswith("__node:=")]
    name = node[0] if node else settings["names"].get(program, program)
    with (folder / f"{name}.told").open("a") as file:
        file.write(
            json.dumps({"words": [program, *words], "folder": str(Path.cwd()), "environment": dict(os.environ)}) + "\n"
        )
    missing = [each for each in settings["needs"].get(name, ()) if not (folder / f"{each}.runs").exists()]
    if missing:
        print("needs", *missing, flush=True)
        sys.exit(9)
    listen_to_signals(folder, name, settings["manners"].get(name, ""))
    note(folder, f"start {name}")
    (folder / f"{name}.runs").write_text(str(os.getpid()))
    print(f"{name} says hello", flush=True)
    if name in settings["ends"]:
        time.sleep(0.2)
        note(folder, f"end {name}")
        sys.exit(settings["ends"][name])
    open_port(settings["ports"].get(name))
    print(settings["says"].get(name, ""), flush=True)
    run(folder, name, settings["manners"].get(name, ""))


def note(folder: Path, line: str) -> None:
    with (folder / "journal").open("a") as file:
        file.write(f"{line}\n")


def open_port(port: int | None) -> None:
    if port is not None:
        time.sleep(0.3)
        server = socket.socket()
        # The test holds the port, so that nobody else gets it.
        server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        server.bind(("127.0.0.1", port))
        server.listen()
        globals()["kept"] = server


def listen_to_signals(folder: Path, name: str, manners: str) -> None:
    def end(number: int, _frame: object) -> None:
        if manners == "stubborn" and number == signal.SIGINT:
            return
        note(folder, f"stop {name}")
        (folder / f"{name}.runs").unlink(missing_ok=True)
        sys.exit(0)

    for each in (signal.SIGINT, signal.SIGTERM):
        signal.signal(each, signal.SIG_IGN if manners == "deaf" else end)


def run(folder: Path, name: str, manners: str) -> None:
    if manners == "parent" and os.fork() == 0:
        # What leaves its parent's session and group, as daemons do.
        os.setsid()
        (folder / f"{name}.child").write_text(str(os.getpid()))
    if manners == "short" and len((folder / f"{name}.told").read_text().splitlines()) == 1:
        note(folder, f"fall {name}")
        sys.exit(3)
    while True:
        signal.pause()


def answer(folder: Path, settings: dict[str, dict[str, str]], words: list[str]) -> None:
    """Answers as the tool `ros2` does."""
    match words:
        case ["topic", "echo", "--once", topic]:
            sys.exit(0 if (folder / f"{settings['topics'][topic]}.runs").exists() else 1)
        case ["service", "list"]:
            print(
                *(each for each, node in settings["services"].items() if (folder / f"{node}.runs").exists()), sep="\n"
            )
        case ["action", "list"]:
            pass
        case ["lifecycle", "set", node, transition]:
            note(folder, f"{transition} {node}")
            (folder / "state").write_text({"configure": "inactive", "activate": "active"}[transition])
        case ["lifecycle", "get", _]:
            print((folder / "state").read_text(), "[3]")
        case ["component", "load", container, _, plugin, *_]:
            note(folder, f"load {plugin} into {container}")
        case _:
            sys.exit(f"what is {words}?")


main()
