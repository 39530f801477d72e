"""edmill: certified event-driven simulation of ball mills.

    import edmill
    run = edmill.run(edmill.Case.spex8000(balls=28, diameter="4.76 mm"), until="2 s")
    run.milling_dose_rate       # W
    run.events["milling_dose"]  # a NumPy array with a number for each impact

Quantities are strings with units; numbers without a unit are for counts and ratios. The manual explains cases, outputs and precisions.
"""
from ._edmill import InputError, UndecidedError, __version__
from .callbacks import ContactLaw, Impact, Running
from .case import Case
from .dem import Deck, export, import_dump, limit
from .judges import (Agreement, Certification, CertifiedEvent, Judgement, Proof, ProvenEvent, Shadow, audit, certify, check,
                     check_certificate, compare, prove, shadow)
from .runs import Interrupted, Run, report, run
from .studies import Study, optimize, sweep

__all__ = ["Agreement", "Case", "Certification", "CertifiedEvent", "ContactLaw", "Deck", "Impact", "InputError", "Interrupted", "Judgement",
           "Proof", "ProvenEvent", "Run", "Running", "Shadow", "Study", "UndecidedError", "__version__", "audit", "certify", "check",
           "check_certificate", "compare", "export", "import_dump", "limit", "optimize", "prove", "report", "run", "shadow", "sweep"]
