"""Feed all readers of archgen with inputs that coverage guides, and keep those at which one breaks. `make fuzz` runs it.

    python -m tests.fuzz.run_fuzz --seconds 600 --seed 1 --work .make/fuzzed [TARGET...]
    python -m tests.fuzz.run_fuzz --minimise .make/fuzzed/found/launch_xml-IndexError-launch_context-resolve

Where Atheris is installed, it sees which ways through archgen an input takes, and goes on from those that took a new one;
else inputs are changed from the fixtures alone. One process at a time feeds one target; what breaks is written, once for each
place, to `WORK/found/`, and is the input of a test when it lies in tests/fuzz/kept.
"""

from __future__ import annotations

import argparse
import gc
import hashlib
import importlib
import json
import os
import pkgutil
import random
import re
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, NoReturn

from tests.fuzz.fuzz_mutations import SEPARATOR, list_words, mutate_input

if TYPE_CHECKING:
    # What is imported before Atheris has prepared archgen would not be watched: targets are asked for later.
    from tests.fuzz.fuzz_targets import Target

GUIDING_ROOMS = (
    *(
        "plugins",
        "importers",
        "syntax",
        "schema",
        "compose",
        "link",
        "project",
        "model",
        "derivation",
        "analyses",
        "checking",
    ),
    *("passes", "edit", "merge", "git", "diagnostics", "conformance", "lsp", "live"),
)
"""What is watched for new ways: the rooms that read and judge. To prepare the others, too, takes as long again, and slows each input."""
PROCESSOR_SECONDS = 10
_ENDING_SECONDS = 150
"""What the process of one target may take beside the time to feed it: libFuzzer itself ends an input after 100 s."""
MEMORY_BYTES = 1_000_000_000
INPUTS_FILE = Path(__file__).with_name("inputs.json")
"""How many inputs of each target a test takes: about those of a minute. A minute itself would be another run each time."""
_MEMORY_FOLDER = "/dev/shm"  # noqa: S108 - whose folders below it are our own
MAX_BYTES = 20_000
"""An input is no larger: what takes long although it is small is what is looked for."""


class TooLongError(BaseException):
    """An input takes longer than any may; no handler of archgen's takes it for an error of its own."""


def make_folder(base: Path) -> Path:
    """Return an empty folder for an input."""
    folder = base / "input"
    if folder.exists():
        shutil.rmtree(folder)
    folder.mkdir(parents=True)
    return folder


def find_fault(target: Target, data: bytes, base: Path) -> tuple[str, str] | None:
    """Return where and how a target breaks at an input, or None."""
    parts = data.split(SEPARATOR)
    parts = (parts + [b""] * len(target.kinds))[: len(target.kinds)]
    folder = make_folder(base) if target.writes else base
    try:
        with _limit_time():
            target.read(parts, folder)
    except (Exception, TooLongError) as error:  # noqa: BLE001 - whatever it is, it is what is looked for
        return _name_place(error), "".join(traceback.format_exception(error))[-6000:]
    return None


@contextmanager
def _limit_time() -> Iterator[None]:
    def stop(_number: int, _frame: FrameType | None) -> NoReturn:
        raise TooLongError

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, PROCESSOR_SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def _name_place(error: BaseException) -> str:
    """Return the kind of an error and the line of archgen that it comes from: faults of one place are one."""
    frames = [
        frame
        for frame in traceback.extract_tb(error.__traceback__)
        if "/archgen/" in frame.filename and "/tests/" not in frame.filename
    ]
    if isinstance(error, TooLongError | RecursionError | MemoryError):
        frames = frames[:6]
    place = f"{Path(frames[-1].filename).stem}-{frames[-1].name}" if frames else "oracle"
    said = (
        re.sub(r"\W+", "_", re.sub(r"`[^`]*`|[0-9]+", "", str(error).partition("\n")[0]))[:60]
        if isinstance(error, AssertionError)
        else ""
    )
    return re.sub(r"[^\w.-]", "", f"{type(error).__name__}-{place}-{said}").rstrip("-_")


class FuzzRun:
    """What is done with each input of one target, and what is counted."""

    def __init__(self, target: Target, work: Path, seed: int, limit: int = 0) -> None:
        self.target, self.work, self.limit = target, work, limit
        self.seeds = list(dict.fromkeys(seed for seed in target.list_seeds() if len(seed) <= MAX_BYTES))
        self.words = list_words(self.seeds)
        self.draw = random.Random(seed)  # noqa: S311 - the same inputs for the same seed
        self.base = work
        self.count = 0
        self.faults: dict[str, int] = {}

    def is_over(self, begin: float, seconds: float) -> bool:
        """Whether it has taken the inputs that it was to take, or the time that it has for them where these are not counted."""
        return self.count >= self.limit if self.limit else time.monotonic() - begin > seconds

    def begin(self) -> None:
        """Make the folder of the inputs, in the process that reads them."""
        self.base = Path(
            tempfile.mkdtemp(prefix="archgen-fuzz-", dir=_MEMORY_FOLDER if Path(_MEMORY_FOLDER).is_dir() else None)
        )

    def take_input(self, data: bytes) -> None:
        """Feed one input."""
        self.count += 1
        if not self.count % 200:
            gc.collect()
        fault = find_fault(self.target, data, self.base)
        if fault is None:
            return
        name = f"{self.target.name}-{fault[0]}"
        kept = self.work / "found" / name
        kept.parent.mkdir(parents=True, exist_ok=True)
        if not kept.exists() or len(data) < kept.stat().st_size:
            kept.write_bytes(data)
            kept.with_name(f"{name}.txt").write_text(fault[1], encoding="utf-8", errors="replace")
        self.faults[name] = self.faults.get(name, 0) + 1

    def mutate(self, data: bytes, max_size: int, seed: int) -> bytes:
        """Return a changed input."""
        return mutate_input(self.target.kinds, data, self.words, random.Random(seed))[:max_size]  # noqa: S311 - as above

    def write_counts(self, seconds: float) -> None:
        """Write what was counted."""
        file = self.work / "counts" / f"{self.target.name}.json"
        file.parent.mkdir(parents=True, exist_ok=True)
        before = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
        counts = {
            "target": self.target.name,
            "seeds": len(self.seeds),
            "inputs": self.count + before.get("inputs", 0),
            "seconds": round(seconds + before.get("seconds", 0), 1),
            "processor_seconds": round(time.process_time() + before.get("processor_seconds", 0), 1),
            "faults": {**before.get("faults", {}), **self.faults},
        }
        file.write_text(json.dumps(counts), encoding="utf-8")
        shutil.rmtree(self.base, ignore_errors=True)


def minimise(target: Target, data: bytes, base: Path) -> bytes:
    """Return as little of an input as breaks at the same place: pieces are left out, lines first, ever smaller ones."""
    wanted = find_fault(target, data, base)
    if wanted is None:
        return data
    for pieces in (data.splitlines(keepends=True), None):
        left = list(pieces or [data[index : index + 1] for index in range(len(data))])
        size = max(1, len(left) // 2)
        while size:
            place = 0
            while place < len(left):
                tried = left[:place] + left[place + size :]
                fault = find_fault(target, b"".join(tried), base)
                if fault is not None and fault[0] == wanted[0]:
                    left = tried
                else:
                    place += size
            size //= 2
        data = b"".join(left)
    return data


def _minimise_files(paths: Sequence[Path]) -> int:
    """Make kept inputs smaller; each is called after its target."""
    from tests.fuzz.fuzz_targets import list_targets

    targets = {target.name: target for target in list_targets()}
    with tempfile.TemporaryDirectory() as base:
        for path in paths:
            data = minimise(targets[path.name.partition("-")[0]], path.read_bytes(), Path(base))
            sys.stdout.write(f"{path}: {path.stat().st_size} bytes, {len(data)} left\n")
            path.write_bytes(data)
    return 0


def _feed_unguided(run: FuzzRun, seconds: float) -> None:
    begin = time.monotonic()
    for seed in run.seeds:
        if run.is_over(begin, seconds / 2):
            break
        run.take_input(seed)
    while not run.is_over(begin, seconds):
        run.take_input(run.mutate(run.draw.choice(run.seeds), MAX_BYTES, run.draw.getrandbits(32)))
    run.write_counts(time.monotonic() - begin)


def _feed_guided(atheris: Any, run: FuzzRun, seconds: float, seed: int) -> NoReturn:  # noqa: ANN401 - a module that need not be there
    corpus, first = run.work / "corpus" / run.target.name, run.base / "seeds"
    corpus.mkdir(parents=True, exist_ok=True)
    first.mkdir()
    for data in run.seeds:
        (first / hashlib.sha1(data, usedforsecurity=False).hexdigest()).write_bytes(data)
    begin = time.monotonic()
    sys.stdout.flush()

    def take_input(data: bytes) -> None:
        run.take_input(data)
        if run.is_over(begin, seconds):
            run.write_counts(time.monotonic() - begin)
            # libFuzzer's own end tells its counts, and takes them from what is on the terminal.
            os._exit(0)

    log = os.open(run.work / "counts" / f"{run.target.name}.log", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(log, 2)
    options = [
        f"-seed={seed}",
        f"-max_len={MAX_BYTES}",
        "-rss_limit_mb=0",
        "-timeout=100",
        "-len_control=0",
        "-reload=0",  # or it would feed again what it has written, some time after
        f"-artifact_prefix={run.work}/found/{run.target.name}-stopped-",
    ]
    atheris.Setup(["fuzz", *options, str(corpus), str(first)], take_input, custom_mutator=run.mutate)
    atheris.Fuzz()
    os._exit(0)


def _import_all() -> None:
    """Import all of archgen, once for all targets, so that each process that is forked has it and its counters."""
    import archgen

    for module in pkgutil.walk_packages(archgen.__path__, "archgen."):
        if "backends" not in module.name and not module.name.endswith("__main__"):
            importlib.import_module(module.name)


def _prepare_atheris() -> Any:  # noqa: ANN401 - as above
    try:
        import atheris
    except ImportError:
        _import_all()
        return None
    sys.stderr.write("instrumenting archgen\n")
    quiet = os.dup(2)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    with atheris.instrument_imports(include=[f"archgen.{room}" for room in GUIDING_ROOMS]):
        _import_all()
    os.dup2(quiet, 2)
    return atheris


def wait_for(child: int, seconds: float) -> None:
    """Wait until a process ends, and end it where an input waits for ever: only its processor time is limited there."""
    end = time.monotonic() + seconds
    with suppress(ChildProcessError):
        while os.waitpid(child, os.WNOHANG)[0] == 0:
            if time.monotonic() > end:
                os.kill(child, signal.SIGKILL)
                os.waitpid(child, 0)
                return
            time.sleep(0.01)


def _feed_target(atheris: Any, run: FuzzRun, seconds: float, seed: int) -> None:  # noqa: ANN401 - as above
    """Feed one target in a process of its own."""
    child = os.fork()
    if child:
        wait_for(child, 2 * seconds + _ENDING_SECONDS)
        return
    try:
        with Path("/proc/self/statm").open(encoding="ascii") as file:
            used = int(file.read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY_BYTES, resource.RLIM_INFINITY))
        run.begin()
        if atheris is None:
            _feed_unguided(run, seconds)
        else:
            _feed_guided(atheris, run, seconds, seed)
    except BaseException:  # noqa: BLE001 - the process is a copy of its parent: it must not go on as that
        traceback.print_exc()
        os._exit(1)
    os._exit(0)


def main(words: Sequence[str] | None = None) -> int:
    """Feed the targets; the exit status is 1 where one broke."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("targets", nargs="*")
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=1, help="how often all targets have their turn")
    parser.add_argument(
        "--counted",
        action="store_true",
        help="feed as many inputs as tests/fuzz/inputs.json says, the same ones each time, not those of some seconds",
    )
    parser.add_argument("--work", type=Path, default=Path(".make/fuzzed"))
    parser.add_argument("--minimise", type=Path, nargs="+", help="leave out of these inputs what they break without")
    parser.add_argument(
        "--replay", action="store_true", help="feed what is in WORK/corpus once, in one process, for coverage.py"
    )
    given = parser.parse_args(words)
    if given.minimise:
        _fork_templates()
        return _minimise_files(given.minimise)
    work: Path = given.work.resolve()
    for folder in ("found", "counts", "corpus"):
        (work / folder).mkdir(parents=True, exist_ok=True)
    os.environ["XDG_CACHE_HOME"] = str(work / "cache")
    os.environ["COLUMNS"] = "100"
    warnings.simplefilter("ignore")
    atheris = None if given.replay else _prepare_atheris()
    from tests.fuzz.fuzz_targets import list_targets

    targets = [target for target in list_targets() if not given.targets or target.name in given.targets]
    _fork_templates()
    if given.replay:
        return _replay_corpus(targets, work)
    limits = json.loads(INPUTS_FILE.read_text(encoding="utf-8")) if given.counted else {}
    runs = [FuzzRun(target, work, given.seed, limits.get(target.name, 0)) for target in targets]
    gc.collect()
    gc.freeze()  # what is imported stays: to look through it again and again would cost more than the inputs
    shares = sum(target.share for target in targets)
    for number in range(given.rounds):
        for run in runs:
            _feed_target(atheris, run, given.seconds * run.target.share / shares / given.rounds, given.seed + number)
    return _report(targets, work)


def _replay_corpus(targets: Sequence[Target], work: Path) -> int:
    """Feed the inputs of a run again: which lines they execute is measured from outside."""
    faults = 0
    with tempfile.TemporaryDirectory() as base:
        for target in targets:
            for path in sorted((work / "corpus" / target.name).glob("*")):
                faults += find_fault(target, path.read_bytes(), Path(base)) is not None
    return int(faults > 0)


def _fork_templates() -> None:
    from archgen.emit import text
    from tests.forked_templates import FORKING

    vars(text)["subprocess"] = FORKING


def _report(targets: Sequence[Target], work: Path) -> int:
    """Print what was counted for each target; return 1 where one broke."""
    lines, totals = [], [0, 0.0, 0.0, 0]
    for target in targets:
        file = work / "counts" / f"{target.name}.json"
        if not file.exists():
            lines.append(f"{target.name:16} came to no end: {work}/counts/{target.name}.log says why")
            totals[3] += 1
            continue
        counts = json.loads(file.read_text(encoding="utf-8"))
        log = file.with_suffix(".log")
        edges = re.findall(r"cov: ([0-9]+)", log.read_text(encoding="utf-8", errors="replace")) if log.exists() else []
        numbers = (counts["inputs"], counts["seconds"], counts["processor_seconds"], len(counts["faults"]))
        totals = [total + number for total, number in zip(totals, numbers, strict=True)]
        lines.append(_write_line(target.name, numbers, f", {edges[-1]} edges" if edges else ""))
        lines += [f"    {name} ({count} times)" for name, count in counts["faults"].items()]
    sys.stdout.write("\n".join((*lines, _write_line("all", totals, ""), "")))
    return int(totals[3] > 0)


def _write_line(name: str, numbers: Sequence[float], more: str) -> str:
    inputs, seconds, processor_seconds, faults = numbers
    return f"{name:16} {inputs:9,} inputs, {seconds:8.1f} s, {processor_seconds:8.1f} s of the processor, {faults} faults{more}"


if __name__ == "__main__":
    sys.exit(main())
