// Colours and sizes of the page.
import { createTheme, type MantineColorsTuple } from '@mantine/core';

// The amber of the crescent: selection, what is active.
const amber: MantineColorsTuple = ['#fff8e6', '#ffeecb', '#ffdc98', '#ffc960', '#f9b833', '#f0aa1c', '#d9930b', '#ad7200', '#855700', '#5e3d00'];

export const theme = createTheme({
  primaryColor: 'amber',
  primaryShade: { light: 8, dark: 5 },
  colors: { amber },
  autoContrast: true,
  fontFamily: 'system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif',
  defaultRadius: 'md',
  cursorType: 'pointer',
  components: {
    Button: { defaultProps: { variant: 'filled' } },
    Tooltip: { defaultProps: { openDelay: 400, withArrow: true, fz: 'xs' } },
    ActionIcon: { defaultProps: { variant: 'subtle', color: 'gray', size: 'lg' } },
    NumberInput: { defaultProps: { size: 'xs' } },
    Select: { defaultProps: { size: 'xs', comboboxProps: { withinPortal: true } } },
    TextInput: { defaultProps: { size: 'xs' } },
    ColorInput: { defaultProps: { size: 'xs' } },
    Switch: { defaultProps: { size: 'xs' } },
    Modal: { defaultProps: { closeButtonProps: { 'aria-label': 'Close' } } },
    Slider: { defaultProps: { size: 4, thumbSize: 14, label: null } },
  },
});
