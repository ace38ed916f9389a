"""Activate jobs: gates (`every`, `throttle`), jitter, and what a job reads when it starts.

Handle samples that arrive at their reader: fire it, fill one of the slots that must all be filled, or keep the
sample.
"""

from __future__ import annotations

from collections.abc import Sequence
from heapq import heappush
from typing import Any

from archgen.simulation.run_state import Job
from archgen.simulation.simulation_plan import SLOT_ANY, SLOT_SAMPLED
from archgen.simulation.simulation_run import (
    ACTIVITY_RELEASE,
    ALL_WIRES,
    HELD_FIRING,
    JOB_END,
    LOAD_ONLY,
    NO_WIRE,
    SimulationRun,
)


def passes_gate(run: SimulationRun, now: int, activity: int) -> bool:
    """Return whether an activation passes `every` and `throttle`, and advance their state."""
    planned, activities = run.plan.activities[activity], run.activities
    if planned.every > 1:
        activities.every_counter[activity] = (activities.every_counter[activity] + 1) % planned.every
        if activities.every_counter[activity]:
            return False
    last_passed = activities.last_passed[activity]
    if planned.throttle and last_passed >= 0 and now - last_passed < planned.throttle:
        return False
    activities.last_passed[activity] = now
    return True


def hold_firing(run: SimulationRun, now: int, activity: int, wire: int, sample: Any) -> None:  # noqa: ANN401 - see Job
    """Hold back an activation by data for up to the activity's jitter; activations keep their order."""
    activities = run.activities
    # Never earlier than the activation before it, since `held_firings` is emptied in order.
    release_time = max(now + run.draw_time(activity, 0, activities.jitter[activity]), activities.held_until[activity])
    activities.held_until[activity] = release_time
    activities.held_firings[activity].append((wire, sample))
    heappush(run.heap, (release_time << 2 | ACTIVITY_RELEASE, activity, HELD_FIRING))


def fire_activity(run: SimulationRun, now: int, activity: int, wire: int, sample: Any) -> None:  # noqa: ANN401 - see Job
    """Activate an activity: queue a job for its executor.

    With a declared response the job begins at once and ends on time; only its load is queued.
    """
    activities, start_up = run.activities, run.start_up
    if not start_up.awaited_wires[activity]:
        previous = activities.last_activation[activity]
        if previous < 0:
            start_up.first_counted[activity] = start_up.activation_count[activity]
        elif now - previous > activities.activation_gap[activity]:
            activities.activation_gap[activity] = now - previous
        activities.last_activation[activity] = now
    if wire >= 0:
        callback = run.wires.callback[wire]
    else:
        callback = activities.clock_callback[activity] if wire == NO_WIRE else activities.joint_callback[activity]
    if wire == NO_WIRE and run.callbacks.skips_ticks[callback] and run.callbacks.pending[callback]:
        return
    start_up.activation_count[activity] += 1
    if activities.declared_response[activity] is not None:
        _start_declared_job(run, now, activity, wire, sample)
        wire = LOAD_ONLY
    queue_callback(run, callback, (now, wire, sample, run.sequence))


def queue_callback(run: SimulationRun, callback: int, job: Job) -> None:
    """Queue what a callback has to do, and wake its executor if it has a thread free."""
    run.sequence += 1
    run.callbacks.pending[callback].append(job)
    executor = run.callbacks.executor[callback]
    run.executors.waiting_count[executor] += 1
    if run.executors.free_count[executor]:
        run.woken_executors.append(executor)


def _start_declared_job(run: SimulationRun, now: int, activity: int, wire: int, sample: Any) -> None:  # noqa: ANN401 - see Job
    """Start a job with a declared response: it ends within the declared time whatever the load."""
    activities = run.activities
    job = (now, wire, sample, run.sequence)
    if wire >= 0 and not run.wires.is_request[wire]:
        run.wires.waiting_count[run.wires.queue[wire]] -= 1
    read_inputs(run, now, activity, job)
    declared = activities.declared_response[activity] or 0
    shortest = min(activities.shortest_time[activity], declared)
    # Jobs of one activity end in order, as they would on one thread.
    end = max(now + run.draw_time(activity, shortest, declared - shortest), activities.declared_end[activity])
    activities.declared_end[activity] = end
    # `read` has just counted this job, so its number is one less than the count.
    activities.declared_jobs[activity].append((now, wire, activities.started[activity] - 1))
    # END, -1 - at, 0)) | Activities are encoded as negative numbers here; thread numbers are not negative.
    heappush(run.heap, (end << 2 | JOB_END, -1 - activity, 0))


def read_inputs(run: SimulationRun, now: int, activity: int, job: Job) -> None:
    """Read the inputs of a job that starts: the samples that fired it, and the newest of every other input."""
    activities, wires = run.activities, run.wires
    dropped_samples: Sequence[tuple[int, int]] = ()
    wire = job[1]
    if wire >= 0:
        if wires.newest_job[wire] > job[2]:
            dropped_samples = _take_sample(run, wire, job[2])
        else:
            keep_sample(run, wire, job[2])
    elif wire == ALL_WIRES:
        dropped_samples = _take_joint_samples(run, now, activity, job[2])
    for queue in wires.sampled_queues[activity]:
        wires.waiting_count[queue] = 0
    # Requests that came before this start are answered at its end; later ones wait for the next job.
    if activities.waiting_requests[activity]:
        requests, activities.waiting_requests[activity] = activities.waiting_requests[activity], []
        activities.accepted_requests[activity].append((activities.started[activity], requests))
    if run.aged_wires[activity]:
        _record_read_ages(run, now, activity)
    if activities.is_watched[activity]:
        activities.job_starts[activity].append(now)
        activities.job_activations[activity].append(job[0])
        for wire in wires.logged_wires[activity]:
            wires.source_log[wire].append(wires.newest_job[wire])
    activities.started[activity] += 1
    for wire, sample in dropped_samples:
        keep_sample(run, wire, sample)


def _record_read_ages(run: SimulationRun, now: int, activity: int) -> None:
    """Record how long ago what a job reads was sent, where its inputs fire nobody."""
    newest_job, largest_age = run.wires.newest_job, run.wires.largest_age
    for wire, source_ends in run.aged_wires[activity]:
        read_job = newest_job[wire]
        if read_job >= 0 and now - source_ends[read_job] > largest_age[wire]:
            largest_age[wire] = now - source_ends[read_job]


def _take_sample(run: SimulationRun, wire: int, sample: int) -> Sequence[tuple[int, int]]:
    """Let a job that starts read the sample that fired it. Return the wire and what `every` or `throttle` has dropped there
    since then: that came later, and stays for the next job.
    """
    newest = run.wires.newest_job[wire]
    keep_sample(run, wire, sample)
    return ((wire, newest),) if newest > sample and run.wires.keeps_order[wire] else ()


def _take_joint_samples(
    run: SimulationRun, now: int, activity: int, samples: Sequence[int]
) -> Sequence[tuple[int, int]]:
    """Let a job that starts read the samples that fired it together (-1 for a wire that brought none of them). Return what
    was dropped since then, as `_take_sample` does.
    """
    if run.activities.matchers[activity] is not None:
        _record_fusion(run, now, activity, samples)
    return [
        dropped_sample
        for wire, sample in zip(run.plan.activities[activity].captured_wires, samples, strict=True)
        if sample >= 0
        for dropped_sample in _take_sample(run, wire, sample)
    ]


def keep_sample(run: SimulationRun, wire: int, sample: int) -> None:
    """Keep a sample for the jobs to come, in place of what came to the same memory before."""
    newest_job = run.wires.newest_job
    newest_job[wire] = sample
    for rival in run.wires.rivals[wire]:
        newest_job[rival] = -1


def stamp_of(run: SimulationRun, wire: int, sample: int) -> int:
    """Return the stamp of a sample: when the job that sent it sampled; 0 for what is published once."""
    samplings = list_samplings(run, run.wires.source[wire])
    return samplings[sample] if samplings else 0


def list_samplings(run: SimulationRun, activity: int) -> Sequence[int]:
    """Return when the jobs of an activity sampled the world: as they were activated, where no tick is skipped."""
    activities, callback = run.activities, run.activities.clock_callback[activity]
    skips_ticks = callback >= 0 and run.callbacks.skips_ticks[callback]
    return (activities.job_starts if skips_ticks else activities.job_activations)[activity]


def _record_fusion(run: SimulationRun, now: int, activity: int, samples: Sequence[int]) -> None:
    """Record how old and how far apart the samples are that a job with matched inputs has taken."""
    activities, wires = run.activities, run.plan.activities[activity].captured_wires
    stamps = [stamp_of(run, wire, sample) for wire, sample in zip(wires, samples, strict=True) if sample >= 0]
    activities.fused_age[activity] = max(activities.fused_age[activity], now - min(stamps))
    activities.fused_spread[activity] = max(activities.fused_spread[activity], max(stamps) - min(stamps))


def deliver_sample(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Deliver a sample at time `now`: fire its reader, fill a slot of an all-of trigger, or keep it."""
    wires, activities = run.wires, run.activities
    slot = wires.slot[wire]
    if run.start_up.awaited_wires[wires.target[wire]]:
        run.start_up.note_sample(wires.source[wire], wires.target[wire], wire, sample)
    if slot == SLOT_SAMPLED:
        if wires.is_request[wire]:
            wires.newest_job[wire] = sample
            activities.waiting_requests[wires.target[wire]].append(wire)
        elif wires.callback[wire] >= 0:
            _queue_storing(run, now, wire, sample)
        else:
            store_sample(run, wire, sample)
    elif slot == SLOT_ANY:
        _fire_by_any(run, now, wire, sample)
    elif activities.matchers[wires.target[wire]] is not None:
        _match_sample(run, now, wire, slot, sample)
    else:
        _fill_slot(run, now, wire, slot, sample)


def _fire_by_any(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Fire a reader that any of its inputs fires, if its gates let the sample pass."""
    wires, activities = run.wires, run.activities
    activity = wires.target[wire]
    if wires.is_request[wire]:
        fire_activity(run, now, activity, wire, sample)
    # `every` and `throttle` come before jitter: a throttle measures from what it let through, not from when jitter
    # released it.
    elif activities.is_gated[activity] and not passes_gate(run, now, activity):
        if run.plan.activities[activity].keeps_dropped:
            keep_sample(run, wire, sample)
    elif activities.jitter[activity]:
        hold_firing(run, now, activity, wire, sample)
    else:
        enqueue_sample(run, now, wire, sample)


def store_sample(run: SimulationRun, wire: int, sample: int) -> None:
    """Store a sample that fires nobody: from now on it is what the reader's next job reads."""
    wires = run.wires
    keep_sample(run, wire, sample)
    queue = wires.queue[wire]
    if queue >= 0:
        wires.waiting_count[queue] += 1
        # Nothing is removed, since only the newest sample is ever read. `waiting_count` goes back to 0 when the
        # reader starts: what exceeds `depth` until then was lost.
        if wires.waiting_count[queue] > wires.depth[wire] > 0:
            wires.drop_count[queue] += 1


def _queue_storing(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Queue a sample for the callback that stores it; a full queue keeps the last ones."""
    callback = run.wires.callback[wire]
    pending = run.callbacks.pending[callback]
    if len(pending) == run.callbacks.depth[callback] > 0:
        pending.popleft()
        run.executors.waiting_count[run.callbacks.executor[callback]] -= 1
        run.wires.drop_count[run.wires.queue[wire]] += 1
    queue_callback(run, callback, (now, wire, sample, run.sequence))


def enqueue_sample(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Queue a sample that fires its reader; a full queue drops its oldest sample first."""
    wires, activity, queue = run.wires, run.wires.target[wire], run.wires.queue[wire]
    # A depth of 0 means that no limit is known: the chained comparison is then never true.
    if wires.waiting_count[queue] == wires.depth[wire] > 0:
        _drop_oldest(run, wires.callback[wire], queue)
    wires.waiting_count[queue] += 1
    fire_activity(run, now, activity, wire, sample)


def _drop_oldest(run: SimulationRun, callback: int, queue: int) -> None:
    """Remove the oldest pending job of a queue, and count the drop."""
    pending, wires = run.callbacks.pending[callback], run.wires
    # What only loads the host waits here as well, and came from no queue.
    for position, (_, wire, _, _) in enumerate(pending):
        if wire >= 0 and wires.queue[wire] == queue:
            del pending[position]
            run.executors.waiting_count[run.callbacks.executor[callback]] -= 1
            wires.waiting_count[queue] -= 1
            wires.drop_count[queue] += 1
            return


def _fill_slot(run: SimulationRun, now: int, wire: int, slot: int, sample: int) -> None:
    """Fill one slot of an all-of trigger; when every slot is filled, activate the reader and clear the slots."""
    wires, activities = run.wires, run.activities
    activity = wires.target[wire]
    planned = run.plan.activities[activity]
    wires.arrived_job[wire] = sample
    for rival in wires.rivals[wire]:
        wires.arrived_job[rival] = -1
    # A filled slot whose sample is replaced loses that sample. Slots of inputs published once are always filled.
    if activities.filled_slots[activity] >> slot & 1 and slot not in planned.constant_slots:
        wires.drop_count[wires.queue[wire]] += 1
    activities.filled_slots[activity] |= 1 << slot
    if activities.filled_slots[activity] == (1 << planned.slot_count) - 1:
        activities.filled_slots[activity] = sum(1 << constant_slot for constant_slot in planned.constant_slots)
        _fire_jointly(run, now, activity, [wires.arrived_job[input_wire] for input_wire in planned.captured_wires])


def _match_sample(run: SimulationRun, now: int, wire: int, slot: int, sample: int) -> None:
    """Let a sample wait for those of the same time, and activate the reader for each set that is complete."""
    wires, activity = run.wires, run.wires.target[wire]
    matcher = run.activities.matchers[activity]
    if matcher is None:
        return
    for matched_samples in matcher.add_sample(slot, (stamp_of(run, wire, sample), wire, sample)):
        job_by_wire = {matched_wire: job_number for _, matched_wire, job_number in matched_samples}
        captured_wires = run.plan.activities[activity].captured_wires
        _fire_jointly(run, now, activity, [job_by_wire.get(captured_wire, -1) for captured_wire in captured_wires])
    for dropped_wire in matcher.dropped_wires:
        wires.drop_count[wires.queue[dropped_wire]] += 1
    matcher.dropped_wires.clear()


def _fire_jointly(run: SimulationRun, now: int, activity: int, samples: Sequence[int]) -> None:
    """Activate a reader by samples of several inputs, one for each captured wire (-1: none), if its gates let them pass."""
    activities, planned = run.activities, run.plan.activities[activity]
    if not activities.is_gated[activity] or passes_gate(run, now, activity):
        if activities.jitter[activity]:
            hold_firing(run, now, activity, ALL_WIRES, tuple(samples))
        else:
            fire_activity(run, now, activity, ALL_WIRES, tuple(samples))
    elif planned.keeps_dropped:
        # A rejected activation still makes its samples the newest: a later call of the same reader reads them.
        for wire, sample in zip(planned.captured_wires, samples, strict=True):
            if sample >= 0:
                keep_sample(run, wire, sample)
