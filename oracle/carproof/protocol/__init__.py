"""The protocol: requests and answers as lines of JSON."""
