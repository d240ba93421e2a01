"""The motion that identifies a joint's parameters best."""
