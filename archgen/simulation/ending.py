"""Complete jobs: record the response, make calls, publish outputs, and answer requests."""

from __future__ import annotations

from archgen.simulation.run import LOAD, Run
from archgen.simulation.sending import send
from archgen.simulation.state import Job
from archgen.simulation.threads import leave


def ended(run: Run, now: int, thread: int, version: int) -> None:
    """End the job of a thread, unless the thread was preempted after this end was scheduled."""
    threads = run.threads
    if threads.version[thread] != version:
        return
    threads.version[thread] += 1
    processor = threads.processor[thread]
    threads.running[processor].remove(thread)
    if threads.ready[processor]:
        run.touched.add(processor)
    _complete(run, now, threads.current[thread])


def _complete(run: Run, now: int, at: int) -> None:
    """Complete a job that ran on its thread: publish its results and let the thread go on."""
    steps = run.steps
    wire = steps.request[at]
    # A load-only job stands for the work of an activity with a declared response: its results were published
    # separately.
    if wire != LOAD:
        _finish(run, now, at, (steps.acted[at], wire, steps.started[at] - 1))
    thread = steps.thread[at]
    run.threads.idle[thread] = True
    if run.threads.pool[thread] >= 0:
        leave(run, run.threads.pool[thread])
    if run.threads.shared[thread] or steps.pending[at]:
        run.awake.append(thread)


def _finish(run: Run, now: int, at: int, job: Job) -> None:
    """Record a finished job's response, make its calls, publish its outputs and answer its requests.

    The third field of the job is the job's own number here, not the number of a sample.
    """
    fired, wire, number = job
    steps = run.steps
    _note(run, now, at, now - fired)
    if run.calls[at]:
        for request in _calls(run, at):
            _note_passed(run, request, number)
            send(run, now, request, number)
    for place, targets, conditional, patience in run.outputs[at]:
        if not conditional or _publishes(run, now, at, place, patience):
            for one in targets:
                if conditional:
                    _note_passed(run, one, number)
                send(run, now, one, number)
    # The request that fired this job is answered at once; a periodic server answers all that waited when the job
    # started.
    if wire >= 0 and run.answers[wire] >= 0:
        _note_passed(run, run.answers[wire], number)
        send(run, now, run.answers[wire], number)
    if steps.taken[at]:
        taken, steps.taken[at] = steps.taken[at], []
        for request in taken:
            _note_passed(run, run.answers[request], number)
            send(run, now, run.answers[request], number)


def _note_passed(run: Run, wire: int, number: int) -> None:
    """Log that a job sent on a wire on which not every job sends."""
    if run.wires.noted[wire]:
        run.wires.passed[wire].append(number)


def _note(run: Run, now: int, at: int, response: int) -> None:
    """Record a job's response time and the gap since the activity's previous end, in units."""
    steps = run.steps
    steps.worst[at] = max(steps.worst[at], response)
    if response < steps.best[at] or steps.best[at] < 0:
        steps.best[at] = response
    before = steps.end[at]
    if before >= 0 and now - before > steps.gap[at]:
        steps.gap[at] = now - before
    steps.end[at] = now
    steps.finished[at] += 1
    if steps.watched[at]:
        steps.ends[at].append(now)


def _calls(run: Run, at: int) -> list[int]:
    """Return the wires of the calls that one job makes, in order; fractional calls are spread evenly over the jobs."""
    found: list[int] = []
    due = run.steps.due[at]
    for place, (number, wires) in enumerate(run.calls[at]):
        # The remainder is carried in integers from job to job: 2/3 of a call gives 0, 1, 1, 0, 1, 1, ...
        total = due[place] + number.numerator
        due[place] = total % number.denominator
        found += wires * (total // number.denominator)
    return found


def _publishes(run: Run, now: int, at: int, place: int, patience: int | None) -> bool:
    """Decide whether a conditional output is published now; its promised largest gap is always kept."""
    published, silence = run.steps.published[at], run.steps.silence[at]
    last = published[place]
    # The draw comes first whatever the patience, so that a promise does not shift the random numbers that follow.
    if run.random() >= run.publish_share[at] and (patience is None or (last >= 0 and now - last <= patience)):
        return False
    if last >= 0 and now - last > silence[place]:
        silence[place] = now - last
    published[place] = now
    return True


def keep_promise(run: Run, now: int, at: int) -> None:
    """Finish the oldest job with a declared response."""
    _finish(run, now, at, run.steps.promises[at].popleft())
