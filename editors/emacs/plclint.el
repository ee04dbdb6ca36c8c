;;; plclint.el --- PLC programs with eglot  -*- lexical-binding: t; -*-

;; Emacs 29 or later, which has eglot built in.

;;; Code:

(define-derived-mode plclint-mode prog-mode "PLC"
  "Major mode for PLC programs: Schneider PL7 and Siemens STEP 7."
  (setq-local comment-start "(* ")
  (setq-local comment-end " *)")
  (setq-local comment-start-skip "\\((\\*\\|//\\)[ \t]*"))

(add-to-list 'auto-mode-alist
             '("\\.\\(?:[aA][wW][lL]\\|[sS][tT][lL]\\|[iI][lL]\\|[sS][tT]\\|[lL][dD]\\|[gG][rR]7\\|[sS][fF][cC]\\|[dD][fF][bB]\\|[fF][eE][fF]\\|[sS][cC][yY]\\)\\'"
               . plclint-mode))

(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(plclint-mode . ("plclint" "server"))))

(add-hook 'plclint-mode-hook #'eglot-ensure)

(provide 'plclint)
;;; plclint.el ends here
