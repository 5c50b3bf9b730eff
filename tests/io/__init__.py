# noqa: A005 - the folder mirrors drystone.io
