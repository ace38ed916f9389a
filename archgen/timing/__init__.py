"""Timing: rates, response times, latency, load and bandwidth, from sources to sinks, with exact arithmetic.

Read the folders in this order; each one imports only from those before it and from `analysis`:

- `figures`: `timing_values` (a figure that says what it rests on, and sums of such figures), `tick_unit`, `figure_wording`.
- `system`: what timing works on. `timing_system` holds activities and arcs, `system_builder` reads them off an
  architecture (`activity_builder`, `arc_builder`, `message_sizes`); then who waits for a thread (`thread_pools`), who shares
  which cores (`core_placement`, `unplaced_pools`) and who fires whom (`trigger_graph`).
- `load`: event models and response times, in integer ticks. `event_streams` (how many events fit into a window),
  `busy_windows` (how long work holds a core), `thread_work` and `response_times` (activities one by one on one core);
  `inner_triggers` and `level_cascades` (what an event leads to on its core), `inner_core` and
  `core_responses` (one core), `queue_orders` and `queue_responses` (orders that are written), `shared_cores`,
  `core_paths`, `path_work` and `shared_core_responses` (several), `whole_hosts` (several taken as one); then
  `event_models` (what is activated, arrives and leaves), `load_system` (callbacks that store, priorities that count),
  `storing_waits`, `propagation_steps`, `step_updates` and `event_propagation` (all resources, to a fixed point), `link_queueing` (links as well); `host_loads` and
  `host_verdicts`; last, for whoever asks why, how each figure comes about: `work_terms`,
  `core_terms`, `shared_core_terms`, `response_terms`.
- `rates`: how often things happen and what that means, in Hz and ns, with reasons:
  `triggered_rates`, `output_rates`; then `link_traffic`, `edge_fit`, `service_waiting`.
- `chains`: end to end. `trigger_arrivals`, `step_delays` (what a step adds), `cost_network` and `path_search` (which
  path is worst), `chain_bounds` (the result); then what is asked about it: reasons (`figure_explanations`,
  `working_lines`), `chain_advice`, sensitivity, measurements.
- `search`: what is found by analysing changes. `change_trials` (tries them), `proposals` (how things
  would have to run for chains to be in time), `chain_budgets` (how much each element may take).

`analysis` holds the results of one run, `run_analysis` makes them. docs/timing_bounds.md has the formulas and their sources.
"""
