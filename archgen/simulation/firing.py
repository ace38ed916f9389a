"""Activate jobs: gates (`every`, `throttle`), jitter, and what a job reads when it starts."""

from __future__ import annotations

from heapq import heappush
from typing import Any

from archgen.simulation.run import END, HELD, LOAD, RELEASE, SEVERAL, Run
from archgen.simulation.state import Job


def passes(run: Run, now: int, at: int) -> bool:
    """Return whether an activation passes `every` and `throttle`, and advance their state."""
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
    """Hold back an activation by data for up to the activity's jitter; activations keep their order."""
    steps = run.steps
    # Never earlier than the activation before it, since `held_firings` is emptied in order.
    there = max(now + run.between(at, 0, steps.jitter[at]), steps.held_until[at])
    steps.held_until[at] = there
    steps.held[at].append((wire, sample))
    heappush(run.heap, (there << 2 | RELEASE, at, HELD))


def fire(run: Run, now: int, at: int, wire: int, sample: Any) -> None:  # noqa: ANN401 - see Job
    """Activate an activity: queue a job for its thread.

    With a declared response the job begins at once and ends on time; only its load is queued.
    """
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
    """Start a job with a declared response: it ends within the declared time whatever the load."""
    steps = run.steps
    job = (now, wire, sample)
    if wire >= 0 and not run.wires.request[wire]:
        run.wires.waiting[run.wires.queue[wire]] -= 1
    read(run, now, at, job)
    promised = steps.promised[at] or 0
    low = min(steps.shortest[at], promised)
    # Jobs of one activity end in order, as they would on one thread.
    end = max(now + run.between(at, low, promised - low), steps.promise_end[at])
    steps.promise_end[at] = end
    # `read` has just counted this job, so its number is one less than the count.
    steps.promises[at].append((now, wire, steps.started[at] - 1))
    # END, -1 - at, 0)) | Activities are encoded as negative numbers here; thread numbers are not negative.
    heappush(run.heap, (end << 2 | END, -1 - at, 0))


def read(run: Run, now: int, at: int, job: Job) -> None:
    """Read the inputs of a job that starts: the samples that fired it, and the newest of every other input."""
    steps, wires = run.steps, run.wires
    _, wire, sample = job
    if wire >= 0:
        wires.newest[wire] = sample
    elif wire == SEVERAL:
        for one, number in zip(run.plan.steps[at].captured, sample, strict=True):
            wires.newest[one] = number
    for queue in wires.sampled[at]:
        wires.waiting[queue] = 0
    # Requests that came before this start are answered at its end; later ones wait for the next job.
    if steps.asked[at]:
        steps.taken[at] += steps.asked[at]
        steps.asked[at] = []
    if steps.watched[at]:
        steps.starts[at].append(now)
        steps.firings[at].append(job[0])
        for one in wires.logged[at]:
            wires.log[one].append(wires.newest[one])
    steps.started[at] += 1
