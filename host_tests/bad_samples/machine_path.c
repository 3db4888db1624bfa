/* expect: absolute path /home/someone/pty */
const char *line = "/home/someone/pty";
