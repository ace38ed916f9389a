"""Complete jobs: record the response, make calls, publish outputs, and answer requests."""

from __future__ import annotations

from heapq import heappush

from archgen.simulation.job_activation import deliver_sample, store_sample
from archgen.simulation.simulation_run import LOAD_ONLY, SAMPLE_ARRIVAL, SimulationRun
from archgen.simulation.thread_scheduling import enter_resource, let_others_compute, queue_thread


def end_thread(run: SimulationRun, now: int, thread: int, version: int) -> None:
    """End what a thread has begun, its time slice, or its work up to the use of a resource; not if it was preempted
    after this end was scheduled.
    """
    threads, processors = run.threads, run.processors
    if threads.end_version[thread] != version:
        return
    threads.end_version[thread] += 1
    processor = threads.processor[thread]
    processors.running[processor].remove(thread)
    let_others_compute(run, thread)
    if processors.ready[processor]:
        run.changed_processors.add(processor)
    if threads.time_after_slice[thread]:
        threads.time_left[thread] = threads.time_after_slice[thread]
        queue_thread(run, thread)
    elif threads.later_steps[thread]:
        enter_resource(run, now, thread)
    else:
        complete_callback(run, now, thread)


def complete_callback(run: SimulationRun, now: int, thread: int) -> None:
    """Complete what ran on a thread: publish its results, or store its sample, and let the thread go on."""
    threads, callbacks, executors = run.threads, run.callbacks, run.executors
    callback = threads.callback[thread]
    if run.log is not None:
        run.log.leave_state(run, thread)
    activity, wire = callbacks.activity[callback], threads.firing_wire[thread]
    if callbacks.is_storing[callback]:
        store_sample(run, wire, threads.job_number[thread])
    # A load-only job stands for the work of an activity with a declared response: its results were published
    # separately.
    elif wire != LOAD_ONLY:
        _publish_results(run, now, activity, (threads.job_activation[thread], wire, threads.job_number[thread]))
    executor = callbacks.executor[callback]
    callbacks.is_group_busy[callbacks.group[callback]] = False
    executors.free_count[executor] += 1
    executors.idle_threads[executor].append(thread)
    if executors.waiting_count[executor]:
        run.woken_executors.append(executor)


def _publish_results(run: SimulationRun, now: int, activity: int, job: tuple[int, int, int]) -> None:
    """Record a finished job's response, make its calls, publish its outputs and answer its requests.

    `job` is its activation, the wire that fired it, and its number.
    """
    activation, wire, job_number = job
    activities = run.activities
    _record_response(run, now, activity, now - activation)
    if activities.is_watched[activity]:
        _record_end(activities.job_ends[activity], job_number, now)
    if run.calls[activity]:
        for request in _requests_due(run, activity):
            _log_forwarding(run, request, job_number)
            send_sample(run, now, request, job_number)
    for output, targets, conditional, patience in run.outputs[activity]:
        if not conditional or _decides_to_publish(run, now, activity, output, patience):
            for target_wire in targets:
                if conditional:
                    _log_forwarding(run, target_wire, job_number)
                send_sample(run, now, target_wire, job_number)
    # The request that fired this job is answered at once; a periodic server answers all that waited when the job
    # started.
    if wire >= 0 and run.answer_wires[wire] >= 0:
        _log_forwarding(run, run.answer_wires[wire], job_number)
        send_sample(run, now, run.answer_wires[wire], job_number)
    if activities.accepted_requests[activity]:
        _answer_accepted(run, now, activity, job_number)


def _answer_accepted(run: SimulationRun, now: int, activity: int, job_number: int) -> None:
    """Answer the requests that had waited when a job started."""
    accepted = run.activities.accepted_requests[activity]
    run.activities.accepted_requests[activity] = [entry for entry in accepted if entry[0] != job_number]
    for accepting_job, requests in accepted:
        for request in requests if accepting_job == job_number else ():
            _log_forwarding(run, run.answer_wires[request], job_number)
            send_sample(run, now, run.answer_wires[request], job_number)


def _log_forwarding(run: SimulationRun, wire: int, job_number: int) -> None:
    """Log that a job sent on a wire on which not every job sends."""
    if run.wires.is_noted[wire]:
        run.wires.forwarded_jobs[wire].append(job_number)


def _record_response(run: SimulationRun, now: int, activity: int, response: int) -> None:
    """Record a job's response time and the gap since the activity's previous end, in units."""
    activities = run.activities
    activities.worst_response[activity] = max(activities.worst_response[activity], response)
    if response < activities.best_response[activity] or activities.best_response[activity] < 0:
        activities.best_response[activity] = response
    previous_end = activities.last_end[activity]
    if previous_end >= 0 and now - previous_end > activities.end_gap[activity]:
        activities.end_gap[activity] = now - previous_end
    activities.last_end[activity] = now
    activities.finished[activity] += 1


def _record_end(job_ends: list[int], job_number: int, end: int) -> None:
    """Record when a job ended; -1 stands for those that began before it and have not ended."""
    missing_count = job_number - len(job_ends)
    if missing_count < 0:
        job_ends[job_number] = end
        return
    job_ends.extend([-1] * missing_count)
    job_ends.append(end)


def _requests_due(run: SimulationRun, activity: int) -> list[int]:
    """Return the wires of the calls that one job makes, in order; fractional calls are spread evenly over the jobs."""
    requests: list[int] = []
    remainders = run.activities.call_remainders[activity]
    for position, (calls_per_job, wires) in enumerate(run.calls[activity]):
        # The remainder is carried in integers from job to job: 2/3 of a call gives 0, 1, 1, 0, 1, 1, ...
        numerator = remainders[position] + calls_per_job.numerator
        remainders[position] = numerator % calls_per_job.denominator
        requests += wires * (numerator // calls_per_job.denominator)
    return requests


def _decides_to_publish(run: SimulationRun, now: int, activity: int, output: int, patience: int | None) -> bool:
    """Decide whether a conditional output is published now; its promised largest gap is always kept."""
    last_published, silence = run.activities.last_published[activity], run.activities.output_silence[activity]
    previous = last_published[output]
    # The draw comes first whatever the patience, so that a promise does not shift the random numbers that follow.
    if run.draw_share() >= run.publish_share[activity] and (
        patience is None or (previous >= 0 and now - previous <= patience)
    ):
        return False
    if previous >= 0 and now - previous > silence[output]:
        silence[output] = now - previous
    last_published[output] = now
    return True


def finish_declared_job(run: SimulationRun, now: int, activity: int) -> None:
    """Finish the oldest job with a declared response."""
    _publish_results(run, now, activity, run.activities.declared_jobs[activity].popleft())


def send_sample(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Send a sample, over its link if it has one; the samples of one wire keep their order."""
    wires = run.wires
    if wires.is_direct[wire]:
        # Delivered without an event: most wires are local, and the heap is the most expensive part.
        wires.sent_count += 1
        deliver_sample(run, now, wire, sample)
        return
    arrival = now + wires.best_latency[wire]
    spread = wires.latency_spread[wire]
    if spread:
        # The reader's share of extremes is used, since wires have none of their own.
        arrival = run.draw_time(wires.target[wire], arrival, spread)
    if wires.link[wire] >= 0:
        arrival = _queue_on_link(run, now, arrival, wire)
    last_arrival = wires.last_arrival
    if arrival < last_arrival[wire]:
        arrival = last_arrival[wire]
    else:
        last_arrival[wire] = arrival
    heappush(run.heap, (arrival << 2 | SAMPLE_ARRIVAL, wire, sample))


def _queue_on_link(run: SimulationRun, now: int, arrival: int, wire: int) -> int:
    """Queue a sample for a link's bandwidth and return when it arrives.

    A declared latency includes queueing and is kept; without one, queueing is added on top.
    """
    wires = run.wires
    link, transmission = wires.link[wire], wires.transmission[wire]
    free_from = wires.link_free[link]
    sent_at = (free_from if free_from > now else now) + transmission  # noqa: FURB136 - a call costs more than the comparison
    wires.link_free[link] = sent_at
    wires.link_busy[link] += transmission
    wires.link_wait[link] = max(wires.link_wait[link], sent_at - now)
    declared = wires.declared_latency[wire]
    if declared is None:
        return arrival + sent_at - now
    return max(arrival, min(sent_at, now + declared))
