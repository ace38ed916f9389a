"""Activations: who gets through, what queues up, and what a job takes in when it starts."""

from __future__ import annotations

from heapq import heappush
from typing import Any

from archgen.simulation.run import END, HELD, LOAD, RELEASE, SEVERAL, Run
from archgen.simulation.state import Job


def passes(run: Run, now: int, at: int) -> bool:
    """Say whether an activation gets through `every` and `throttle`."""
    step, steps = run.plan.steps[at], run.steps
    if step.every > 1:
        steps.turn[at] = (steps.turn[at] + 1) % step.every
        if steps.turn[at]:
            return False
    before = steps.let_through[at]
    if step.throttle and before >= 0 and now - before < step.throttle:
        return False
    steps.let_through[at] = now
    return True


def hold(run: Run, now: int, at: int, wire: int, sample: Any) -> None:  # noqa: ANN401 - see Job
    """Hold back what is to fire a step by its jitter, in order."""
    steps = run.steps
    there = max(now + run.between(at, 0, steps.jitter[at]), steps.held_until[at])
    steps.held_until[at] = there
    steps.held[at].append((wire, sample))
    heappush(run.heap, (there << 2 | RELEASE, at, HELD))


def fire(run: Run, now: int, at: int, wire: int, sample: Any) -> None:  # noqa: ANN401 - see Job
    """Activate a step: a job waits for its thread. One whose end was declared begins at once, and only its load waits."""
    steps = run.steps
    before = steps.fired[at]
    if before >= 0 and now - before > steps.firing_gap[at]:
        steps.firing_gap[at] = now - before
    steps.fired[at] = now
    if steps.promised[at] is not None:
        _promise(run, now, at, wire, sample)
        wire = LOAD
    steps.pending[at].append((now, wire, sample))
    thread = steps.thread[at]
    if run.threads.idle[thread]:
        run.awake.append(thread)


def _promise(run: Run, now: int, at: int, wire: int, sample: Any) -> None:  # noqa: ANN401 - see Job
    """Start a job whose end was declared: whatever the load, it ends in the declared time."""
    steps = run.steps
    job = (now, wire, sample)
    if wire >= 0 and not run.wires.request[wire]:
        run.wires.waiting[run.wires.queue[wire]] -= 1
    read(run, now, at, job)
    promised = steps.promised[at] or 0
    low = min(steps.shortest[at], promised)
    end = max(now + run.between(at, low, promised - low), steps.promise_end[at])
    steps.promise_end[at] = end
    steps.promises[at].append((now, wire, steps.started[at] - 1))
    heappush(run.heap, (end << 2 | END, -1 - at, 0))


def read(run: Run, now: int, at: int, job: Job) -> None:
    """Take in what fired a job, and what the other inputs hold."""
    steps, wires = run.steps, run.wires
    _, wire, sample = job
    if wire >= 0:
        wires.newest[wire] = sample
    elif wire == SEVERAL:
        for one, number in zip(run.plan.steps[at].captured, sample, strict=True):
            wires.newest[one] = number
    for queue in wires.sampled[at]:
        wires.waiting[queue] = 0
    if steps.asked[at]:
        steps.taken[at] += steps.asked[at]
        steps.asked[at] = []
    if steps.watched[at]:
        steps.starts[at].append(now)
        steps.firings[at].append(job[0])
        for one in wires.logged[at]:
            wires.log[one].append(wires.newest[one])
    steps.started[at] += 1
