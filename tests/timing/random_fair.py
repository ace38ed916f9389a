"""Random systems of threads that share cores fairly: as a project, and as what the simulated kernel runs."""

from __future__ import annotations

import json
import random

from tests.timing.fair_kernel import FairRun, Kernel, Task

_US = 1000


def draw_fair_system(seed: int) -> tuple[str, Kernel, dict[str, Task], bool]:
    """Return a project, the kernel and the activities that it says, and whether the kernel is EEVDF (else CFS)."""
    dice = random.Random(seed)  # noqa: S311 - a test's dice
    cores, is_eevdf = dice.randint(1, 4), dice.random() < 0.6
    slice_time, tick = dice.choice([1000, 2000, 3000]), dice.choice([0, 1000, 4000])
    features = dice.choice(["plain", "plain", "executors", "pools", "urgent", "gpu"])
    load = dice.uniform(0.15, 0.8) * cores
    count = dice.randint(3, 10)
    weights = [dice.random() ** 2 + 0.02 for _ in range(count)]
    tasks: dict[str, Task] = {}
    threads: list[int] = []
    urgent: set[int] = set()
    process = -1
    for number, weight in enumerate(weights):
        if process < 0 or features not in {"executors", "pools"} or dice.random() < 0.5:
            process += 1
            threads.append(dice.randint(2, 3) if features == "pools" and dice.random() < 0.5 else 1)
            if features == "urgent" and dice.random() < 0.3:
                urgent.add(process)
        share = min(load * weight / sum(weights), 0.9)
        period = dice.choice([10_000, 20_000, 30_000, 50_000, 100_000, 200_000])
        cost = max(int(share * period), 50)
        task = Task(f"n{number}", cost, process, period)
        sources = [
            each for each in tasks.values() if not each.fires and each.process not in urgent and each.process != process
        ]
        if sources and dice.random() < 0.25 and process not in urgent:
            source = dice.choice(sources)
            rate = _find_rate(tasks, source)
            task = Task(task.name, max(int(share * rate), 50), process)
            tasks[source.name] = Task(source.name, source.cost, source.process, source.period, (task.name,))
        if features == "gpu" and dice.random() < 0.5:
            task.uses = max(min(task.cost // 2, 3000), 100)
        tasks[task.name] = task
    kernel = Kernel(cores, slice_time, tick, threads, frozenset(urgent))
    return _write_project(kernel, tasks, lead=5 if is_eevdf else 3), kernel, tasks, is_eevdf


def _find_rate(tasks: dict[str, Task], task: Task) -> int:
    while not task.period:
        task = next(each for each in tasks.values() if task.name in each.fires)
    return task.period


def _write_project(kernel: Kernel, tasks: dict[str, Task], *, lead: int) -> str:
    sources = {name: task.name for task in tasks.values() for name in task.fires}
    components = {
        name: {
            "inputs": {"i": f"{sources[name]}.out"} if name in sources else {},
            "outputs": {"out": {"type": "T", "external": "world"}},
        }
        for name in tasks
    }
    nodes = {}
    for name, task in tasks.items():
        timing: dict[str, object] = {"wcet": f"{task.cost} us", "bcet": f"{task.cost} us"}
        timing |= {"behaviour": "periodic", "period": f"{task.period} us"} if task.period else {"behaviour": "event"}
        if task.uses:
            timing["uses"] = {"gpu": f"{task.uses} us"}
        if task.process in kernel.urgent:
            timing["priority"] = 50
        reentrant = {"reentrant": True} if kernel.threads[task.process] > 1 else {}
        nodes[name] = {"implements": name, "container": f"p{task.process}", "timing": timing, **reentrant}
    fair = {"slice": f"{kernel.slice_time} us", "tick": f"{kernel.tick} us", "lead": lead}
    return json.dumps(
        {
            "groups": {"g": {"components": components}},
            "types": {"T": {"message": "std_msgs/msg/Empty"}},
            "hosts": {"h": {"cores": kernel.cores, "scheduling": {"fair": fair}}},
            "resources": {"gpu": {"host": "h", "scheduling": "fifo"}},
            "containers": {f"p{at}": {"host": "h", "threads": count} for at, count in enumerate(kernel.threads)},
            "nodes": nodes,
        }
    )


def simulate_fair(seed: int, *, runs: int, seconds: float) -> dict[str, int]:
    """Return the longest responses (ns) that some runs of a system see."""
    _, kernel, tasks, is_eevdf = draw_fair_system(seed)
    worst: dict[str, int] = {}
    for number in range(runs):
        dice = random.Random(seed * 100 + number)  # noqa: S311 - a test's dice
        run = FairRun(kernel, tasks, dice, is_eevdf, dice.choice(["last", "fullest", "random"]))
        run.run(int(seconds * 10**6), at_once=number % 2 == 0)
        for name, response in run.worst.items():
            worst[name] = max(worst.get(name, 0), response * _US)
    return worst
