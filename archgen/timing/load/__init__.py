"""The third stage: event streams, response times of hosts and threads, and queueing on links."""
