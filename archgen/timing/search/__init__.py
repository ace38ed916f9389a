"""What is found by trying: the change that would prove a chain, and how much each element may take."""
