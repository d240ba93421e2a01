"""On-line identification: an estimate that follows the joint while it runs."""
