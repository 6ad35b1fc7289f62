"""porolub: porohyperelastic lubrication of soft, fluid-filled layers."""

__version__ = "0.1.0"
