"""What nodes are on the wire once they run: names, quality of service, domain, clock, and whether they run at all."""
