// MLS §7.2.6: what is final stays.
package final_override
  type Voltage = Real(final unit = "V");
  model Main
    Voltage v(unit = "mV") = 1;
  end Main;
end final_override;
