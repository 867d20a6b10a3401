"""Many cases: solved here or on a cluster, each kept as soon as it is finished, so that a stop loses nothing."""
