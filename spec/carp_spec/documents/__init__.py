"""The documents that programs exchange: their classes, readers, writers and JSON Schemas."""
