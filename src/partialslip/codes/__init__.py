"""Files of other codes: results that are read and scored (``score``), models that are written (``export``)."""
