"""Run the program of a generated node whose callbacks compute for a while, and write down when each ran on which thread.

Run by the Python of ROS, with a description as JSON: the module, its class, the time, the file, and for each callback how long
it computes and which messages it sends. The executor is the one that the generated `main` starts.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import threading
import time
from pathlib import Path


def trace_program(description: dict[str, object]) -> None:
    """Start the node, and end it after some time."""
    module = importlib.import_module(str(description["module"]))
    rows: list[tuple[str, int, float, float, float, str]] = []
    message_class = importlib.import_module("std_msgs.msg").String

    def make_callback(name: str, seconds: float, sent: list[str]) -> object:
        def run(self: object, message: object = None) -> None:
            begin, computed = time.monotonic(), time.thread_time()
            while time.thread_time() - computed < seconds:
                pass
            computed = time.thread_time() - computed
            rows.append((name, threading.get_ident(), begin, time.monotonic(), computed, getattr(message, "data", "")))
            for key in sent:
                text = f"{description['file']} {len(rows) - 1}"
                getattr(self.node, f"publish_{key}")(message_class(data=text))  # type: ignore[attr-defined]

        return run

    callbacks = {name: make_callback(name, *each) for name, each in description["callbacks"].items()}  # type: ignore[attr-defined]
    setattr(module, str(description["class"]), type("Traced", (getattr(module, str(description["class"])),), callbacks))

    def end_program() -> None:
        Path(str(description["file"])).write_text(json.dumps(list(rows)), encoding="utf-8")
        os._exit(0)

    timer = threading.Timer(float(str(description["seconds"])), end_program)
    timer.daemon = True
    timer.start()
    module.main()


trace_program(json.loads(sys.argv[1]))
