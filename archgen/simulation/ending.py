"""Jobs end: the response is noted, calls are made, outputs published, and who waits is answered."""

from __future__ import annotations

from archgen.simulation.run import LOAD, Run
from archgen.simulation.sending import send
from archgen.simulation.state import Job
from archgen.simulation.threads import leave


def ended(run: Run, now: int, thread: int, version: int) -> None:
    """End what a thread does, unless it was taken off its core since this end was foreseen."""
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
    """End a job: note its response, publish, answer, and let the thread go on."""
    steps = run.steps
    wire = steps.request[at]
    if wire != LOAD:
        _finish(run, now, at, (steps.acted[at], wire, steps.started[at] - 1))
    thread = steps.thread[at]
    run.threads.idle[thread] = True
    if run.threads.pool[thread] >= 0:
        leave(run, run.threads.pool[thread])
    if run.threads.shared[thread] or steps.pending[at]:
        run.awake.append(thread)


def _finish(run: Run, now: int, at: int, job: Job) -> None:
    """End a job's work: publish, and answer who waits for it. The job has its own number in place of a sample's."""
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
    if wire >= 0 and run.answers[wire] >= 0:
        _note_passed(run, run.answers[wire], number)
        send(run, now, run.answers[wire], number)
    if steps.taken[at]:
        taken, steps.taken[at] = steps.taken[at], []
        for request in taken:
            _note_passed(run, run.answers[request], number)
            send(run, now, run.answers[request], number)


def _note_passed(run: Run, wire: int, number: int) -> None:
    """Note that a job sent something where not every job does."""
    if run.wires.noted[wire]:
        run.wires.passed[wire].append(number)


def _note(run: Run, now: int, at: int, response: int) -> None:
    """Note the end of a job."""
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
    """Give the requests of one job, in order; of a fraction of a call, as many as are due."""
    found: list[int] = []
    due = run.steps.due[at]
    for place, (number, wires) in enumerate(run.calls[at]):
        total = due[place] + number.numerator
        due[place] = total % number.denominator
        found += wires * (total // number.denominator)
    return found


def _publishes(run: Run, now: int, at: int, place: int, patience: int | None) -> bool:
    """Decide on a conditional output; it is never silent for longer than was promised."""
    published, silence = run.steps.published[at], run.steps.silence[at]
    last = published[place]
    if run.random() >= run.publish_share[at] and (patience is None or (last >= 0 and now - last <= patience)):
        return False
    if last >= 0 and now - last > silence[place]:
        silence[place] = now - last
    published[place] = now
    return True


def keep_promise(run: Run, now: int, at: int) -> None:
    """End a job whose end was declared."""
    _finish(run, now, at, run.steps.promises[at].popleft())
