"""A planned wall as things to be put together: solids, frames in metres, contacts, forces."""
