"""Grants of resources that let everybody finish: what robots hold, and the checker of the witnesses."""
