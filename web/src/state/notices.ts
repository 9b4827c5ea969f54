// Messages to the user that come and go.
import { notifications } from '@mantine/notifications';
import type { Failure, Incoming } from '../protocol/messages';

export function complain(failure: Failure): void {
  for (const problem of failure.problems.slice(0, 4)) {
    notifications.show({ color: 'red', title: problem.reason, message: [problem.file, problem.place, problem.hint].filter(Boolean).join(' · '), autoClose: 10000 });
  }
  if (failure.problems.length === 0) notifications.show({ color: 'red', message: failure.kind });
}

export function tell(message: string): void {
  notifications.show({ message, autoClose: 3000 });
}

export function warn(title: string, message: string): void {
  notifications.show({ color: 'red', title, message, autoClose: 10000 });
}

// What the program noticed when it read a file.
export function mention(warning: NonNullable<NonNullable<Incoming['scene']>['warnings']>[number]): void {
  notifications.show({ color: 'yellow', title: warning.reason, message: [warning.place, warning.hint].filter(Boolean).join(' · '), autoClose: 8000 });
}
