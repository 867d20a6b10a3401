"""Frictional contact condensed to the contact line: a small dense problem, whatever the compliances come from.

``pressing``, ``normal``
    The contact under P: forces of the nodes and ends.
``load_path``, ``history``
    Load points in order; the loop over cycles up to the steady state, whose end ``limit`` decides.
``coulomb_legs``, ``coulomb_constant_pressure``, ``coulomb_varying_pressure``, ``coulomb_varying_events``,
``coulomb_coupled``
    Coulomb's law along the load path, one module for each kind of pressure: ``march`` updates slip and shear.
``active_set``
    Multipliers within bounds: which nodes stick, slip or part.
``path_following``
    Loads that change gradually, event by event; ``tableau`` holds its rates.
``step_errors``, ``steps``
    What load steps leave, and whether they suffice.
``contact_line``, ``zone_ends``, ``regime``
    What is read from forces on the line: ends of contact and stick zone between nodes, kinks; the name of the regime.
``partition``, ``warm_start``, ``restart``
    Factors and solutions that are used again.
"""
