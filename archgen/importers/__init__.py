"""What readers of other formats share: the formats that there are, what a reader returns, files read within limits."""
