"""The last stage: latency of each chain, its explanation, and how it compares with measurements."""
