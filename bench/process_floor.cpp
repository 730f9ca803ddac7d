// The lower bound of start_time.py: a static program that does nothing.
int main() { return 0; }
