/* expect: serial_isr: has no vector
 * main() is in another file, which does not see this prototype. */
void serial_isr(void) __interrupt(4);

void serial_isr(void) __interrupt(4)
{
}
