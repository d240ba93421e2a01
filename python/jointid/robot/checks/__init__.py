"""What is held against an identification: torques, another regression, slow motion."""
