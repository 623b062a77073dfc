"""LaCAM: plans of all robots at once, tick by tick, along guides."""
