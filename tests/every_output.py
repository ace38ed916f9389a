"""A program that makes every output that archgen can make of a project, in this process: `PROJECT OUT [PROCESSORS]`.

It is run under other settings, by other Pythons and with the installed wheel, and needs nothing but archgen. The project is a
repository with a commit before the last one, and its two partners `p` and `q` sign at the end.
"""

from __future__ import annotations

import gc
import io
import json
import os
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

from archgen.__main__ import main

PRINTED = (
    "check --format json",
    "check --format sarif",
    "stats --format json",
    "timing",
    "timing --format json",
    "timing --propose",
    "simulate --seconds 2 --seeds 2 --format json",
    "list --of connections --format csv",
    "start",
    "start --format json",
    "owners",
    "diff HEAD~1 HEAD",
    "interfaces --between p q",
    "todo --partner p",
    "todo --partner q --format json --since HEAD~1",
    "impact --partner p --format markdown",
    "impact --partner q --format json",
    "fmt --diff",
    "rename watcher guard --dry-run",
    "move lamp --file lamps/lamp.yaml --dry-run --format json",
    "split watching.yaml --by component --dry-run",
    "merge-check HEAD~1 HEAD",
    "merge-check HEAD~1 HEAD --format json",
    "conform --against ../graph.txt --format json",
    "show watcher",
    "list --of requirements --format json",
    "stats --history",
)
WRITTEN = (
    "build --backend wiki --no-history -o {out}/build",
    "diagram --format svg,png,pdf,dot -o {out}/pictures",
    "pack --resolved -o {out}/resolved.yaml",
    "diff HEAD~1 HEAD --format json -o {out}/diff.json",
    "diff HEAD~1 HEAD --format markdown -o {out}/diff.md",
    "diff HEAD~1 HEAD --format html -o {out}/diff.html",
    "review --base HEAD~1 -o {out}/review",
    "interfaces --between p q -o {out}/interfaces.docx",
    "interfaces --between p q -o {out}/interfaces.html",
    "schema -o {out}/schema.json",
)
ENDINGS = {"reqif": ".reqif", "xmi": ".xmi"}
"""Where the ending of a file's name says which of its forms is wanted."""
_GRAPH = """\
$ ros2 node list
/watcher
/stranger
$ ros2 node info /watcher
/watcher
  Subscribers:
    /way: nav_msgs/msg/Path
  Publishers:
    /alarm: std_msgs/msg/String
"""
"""A robot that is otherwise in some ways."""
SIGNING = "sign p q --by p Ada --by q Ben --date 2026-03-01 -o {out}/signed.docx"


def call(words: list[str]) -> tuple[int, str]:
    """Run a verb; return its status and what it printed."""
    sys.argv = ["archgen", *words]
    out = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    status: object = 0
    with redirect_stdout(out), redirect_stderr(io.TextIOWrapper(io.BytesIO(), encoding="utf-8")) as err:
        try:
            main()
        except SystemExit as stop:
            status = stop.code or 0
        out.flush()
        err.flush()
    assert isinstance(out.buffer, io.BytesIO)
    assert isinstance(err.buffer, io.BytesIO)
    said = out.buffer.getvalue().decode()
    # A backend or pass may refuse a project: what it says then must be the same, too.
    return int(str(status)), said if status == 0 else said + err.buffer.getvalue().decode()


def make_every_output(project: Path, out: Path) -> None:
    """Make everything in a folder; printed text comes into files, too."""
    os.chdir(project)
    (out / "printed").mkdir(parents=True)
    # Beside the project, in whatever folder that lies: findings say the way from one to the other.
    (project.parent / "graph.txt").write_text(_GRAPH, "utf-8")
    backends = json.loads(call(["list", "--of", "backends", "--format", "json"])[1])
    passes = [line.partition(":")[0] for line in call(["transform", "--list"])[1].splitlines() if line[0] != " "]
    verbs = [*WRITTEN]
    for backend in backends:
        verb = {"workspace": "generate", "file": "export"}.get(backend["makes"])
        if verb:
            verbs.append(f"{verb} {backend['id']} -o {{out}}/{verb}/{backend['id']}{ENDINGS.get(backend['id'], '')}")
    verbs += [f"transform {each} -o {{out}}/passes/{each}.yaml" for each in passes]
    statuses = []
    for verb in (*PRINTED, *verbs, SIGNING):
        status, said = call([word.format(out=out) for word in verb.split()])
        statuses.append(f"{status} {verb}")
        if verb in PRINTED or status:
            name = verb.replace(" ", "_").replace("/", "_").replace("{out}", "")
            (out / "printed" / f"{name}.txt").write_text(
                said.replace(str(out), "OUT").replace(str(project), "PROJECT"), "utf-8"
            )
    (out / "statuses.txt").write_text("".join(f"{line}\n" for line in statuses), "utf-8")
    (out / "signed.yaml").write_bytes((project / "agreements/p-q.yaml").read_bytes())


if __name__ == "__main__":
    gc.disable()
    if len(sys.argv) > 3:
        processors = int(sys.argv[3])
        os.cpu_count = lambda: processors
    make_every_output(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
