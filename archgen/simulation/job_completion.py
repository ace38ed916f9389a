"""Complete jobs: record the response, make calls, publish outputs, and answer requests."""

from __future__ import annotations

from archgen.simulation.run_state import Job
from archgen.simulation.sample_sending import send_sample
from archgen.simulation.simulation_run import LOAD_ONLY, SimulationRun
from archgen.simulation.thread_scheduling import leave_pool


def end_thread(run: SimulationRun, now: int, thread: int, version: int) -> None:
    """End the job of a thread, unless the thread was preempted after this end was scheduled."""
    threads = run.threads
    if threads.end_version[thread] != version:
        return
    threads.end_version[thread] += 1
    processor = threads.processor[thread]
    threads.running[processor].remove(thread)
    if threads.ready[processor]:
        run.changed_processors.add(processor)
    _complete_job(run, now, threads.current_activity[thread])


def _complete_job(run: SimulationRun, now: int, activity: int) -> None:
    """Complete a job that ran on its thread: publish its results and let the thread go on."""
    activities = run.activities
    wire = activities.firing_wire[activity]
    # A load-only job stands for the work of an activity with a declared response: its results were published
    # separately.
    if wire != LOAD_ONLY:
        _publish_results(
            run, now, activity, (activities.job_activation[activity], wire, activities.started[activity] - 1)
        )
    thread = activities.thread[activity]
    run.threads.is_idle[thread] = True
    if run.threads.pool[thread] >= 0:
        leave_pool(run, run.threads.pool[thread])
    if run.threads.is_shared[thread] or activities.pending[activity]:
        run.woken_threads.append(thread)


def _publish_results(run: SimulationRun, now: int, activity: int, job: Job) -> None:
    """Record a finished job's response, make its calls, publish its outputs and answer its requests.

    The third field of the job is the job's own number here, not the number of a sample.
    """
    activation, wire, job_number = job
    activities = run.activities
    _record_response(run, now, activity, now - activation)
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
        requests, activities.accepted_requests[activity] = activities.accepted_requests[activity], []
        for request in requests:
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
    if activities.is_watched[activity]:
        activities.job_ends[activity].append(now)


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
