"""What every other package uses, and what knows nothing of contact: arrays, errors, files, output."""
