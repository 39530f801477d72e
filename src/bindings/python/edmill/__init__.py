"""edmill: certified event-driven simulation of ball mills.

    import edmill
    run = edmill.run(edmill.Case.spex8000(balls=28, diameter="4.76 mm"), until="2 s")
    run.dose_rate               # with its 95 % interval [W]
    run.events["milling_dose"]  # a NumPy array with a number for each impact

Quantities are strings with units; numbers without a unit are for counts and ratios. The manual
explains cases, outputs and precisions.
"""
from ._edmill import InputError, UndecidedError, __version__
from .case import Case, EditError, machines, new, variables
from .dem import Deck, export, import_dump, limit
from .judges import (Agreement, Certification, CertifiedEvent, Derivative, Judgement, Proof,
                     ProvenEvent, Sensitivities, Shadow, audit, certify, check, check_certificate,
                     compare, estimate, prove, sensitivity, shadow)
from .runs import ContactLaw, Impact, Interrupted, Run, Running, read_run, report, resume, run
from .studies import Study, Variations, optimize, seeds, sweep, what_decides
from .tables import Records
from .values import Value

__all__ = [
    "Agreement", "Case", "Certification", "CertifiedEvent", "ContactLaw", "Deck", "Derivative",
    "EditError", "Impact", "InputError", "Interrupted", "Judgement", "Proof", "ProvenEvent",
    "Records", "Run", "Running", "Sensitivities", "Shadow", "Study", "UndecidedError", "Value",
    "Variations", "__version__", "audit", "certify", "check", "check_certificate", "compare",
    "estimate", "export", "import_dump", "limit", "machines", "new", "optimize", "prove",
    "read_run", "report", "resume", "run", "seeds", "sensitivity", "shadow", "sweep", "variables",
    "what_decides"
]
