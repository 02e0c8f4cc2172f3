#ifndef COUNTER_H
#define COUNTER_H

void *counter_new(int start);
void counter_free(void *counter);
int counter_next(void *counter);
int counters_alive(void);

#endif
