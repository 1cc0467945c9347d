// For passes that are about depth, stencil and counting alone.
void main() {}
